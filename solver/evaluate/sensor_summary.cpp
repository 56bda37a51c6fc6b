#include "solver/evaluate/sensor_summary.h"

#include <algorithm>
#include <numeric>

#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr double kDaylit = 0.02;  ///< daylight factor from which a point counts as daylit [1]

double share_of(std::span<const double> lux, double least) {
  const auto count = std::ranges::count_if(lux, [&](double x) { return x >= least; });
  return static_cast<double>(count) / static_cast<double>(lux.size());
}

}  // namespace

SensorSummary summary_of(const SensorSet& set, std::vector<double> lux, std::optional<double> daylight_reference) {
  std::ranges::sort(lux);
  const std::size_t n = lux.size();
  SensorSummary s{.name = set.name, .kind = set.kind, .points = n};
  s.mean = std::accumulate(lux.begin(), lux.end(), 0.0) / static_cast<double>(n);
  s.min = lux.front();
  s.max = lux.back();
  s.median = (lux[(n - 1) / 2] + lux[n / 2]) / 2;
  if (s.mean > 0) s.uniformity = s.min / s.mean;
  if (set.threshold) s.threshold = {*set.threshold, share_of(lux, *set.threshold)};
  if (daylight_reference) {
    const double percent = 100 / *daylight_reference;
    s.daylight_factor = {s.mean * percent, s.median * percent, share_of(lux, kDaylit * *daylight_reference)};
  }
  return s;
}

std::vector<SensorSummary> summaries_of(std::span<const SensorSet> sets, const Field& E,
                                        std::optional<double> daylight_reference) {
  std::vector<SensorSummary> summaries;
  std::size_t begin = 0;
  for (const SensorSet& set : sets) {
    std::vector<double> lux(set.points.size());
    for (std::size_t i = 0; i < lux.size(); ++i) lux[i] = photometric(E[begin + i]);
    begin += lux.size();
    if (!lux.empty()) summaries.push_back(summary_of(set, std::move(lux), daylight_reference));
  }
  return summaries;
}

}  // namespace clerestory
