// Figures of a year at a point, from its hours. Prints one CSV row a figure: what, value, unit, bar.

#include <cstdio>
#include <ctime>
#include <vector>

#include "solver/evaluate/annual_figures.h"

namespace clerestory {
namespace {

/// CPU time, so that a busy machine shows less.
void figures_of_points() {
  std::vector<int> hours;
  std::vector<double> diffuse;
  std::vector<float> total, direct;
  std::vector<std::uint8_t> occupied(kHoursOfYear);
  for (int h = 0; h < 8760; ++h) {
    const int of_day = h % 24;
    occupied[static_cast<std::size_t>(h)] = of_day >= 8 && of_day < 18;
    if (of_day < 7 || of_day >= 19) continue;
    hours.push_back(h);
    diffuse.push_back(h);
    total.push_back(static_cast<float>(h * 7919L % 4000));
    direct.push_back(total.back() / 2);
  }
  const YearRules rules = year_rules(hours, diffuse, occupied);
  constexpr int kPoints = 20'000;
  long sum = 0;
  const std::clock_t start = std::clock();
  for (int p = 0; p < kPoints; ++p) {
    total[0] = static_cast<float>(p);  // so that no two points are alike
    sum += figures_of(total, direct, rules, {.total = 0.1, .direct = 0.1}).DA;
  }
  const double s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  std::printf("figures of a year: a point and hour,%.3g,ns,\n", s * 1e9 / kPoints / static_cast<double>(hours.size()));
  std::printf("figures of a year: hours of daylight autonomy at a point,%.6g,h,\n", static_cast<double>(sum) / kPoints);
}

}  // namespace
}  // namespace clerestory

int main() { clerestory::figures_of_points(); }
