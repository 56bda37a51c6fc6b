#include "solver/evaluate/annual_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "solver/model/assert.h"

namespace clerestory {
namespace {

constexpr std::size_t kChunk = 512;  // hours that stay in the first cache: 2 KB

/// Hours with x >= least, for each of some thresholds. Compilers make four lanes of this loop.
template <std::size_t N>
std::array<int, N> count_at_least(const float* x, std::size_t n, const std::array<float, N>& least) {
  std::array<int, N> count{};
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < N; ++k) count[k] += x[i] >= least[k];
  return count;
}

/// x > limit is x >= just_above(limit).
float just_above(float limit) { return std::nextafter(limit, std::numeric_limits<float>::infinity()); }

/// Adds sum of x to lux_hours, and of min(x, T) to cDA: in lanes of a fixed order, the same bits on every processor.
void add_sums(const float* x, std::size_t n, float T, PointYear& year) {
  constexpr std::size_t kLanes = 4;
  double all[kLanes] = {}, up_to_T[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes)
    for (std::size_t k = 0; k < kLanes; ++k) {
      all[k] += x[i + k];
      up_to_T[k] += std::min(x[i + k], T);
    }
  for (; i < n; ++i) {
    all[0] += x[i];
    up_to_T[0] += std::min(x[i], T);
  }
  year.lux_hours += (all[0] + all[1]) + (all[2] + all[3]);
  year.cDA += (up_to_T[0] + up_to_T[1]) + (up_to_T[2] + up_to_T[3]);
}

/// What an illuminance must read at least so that (1 + change) of it is `lux`; no illuminance where nothing is left.
float read_for(double lux, double change) { return static_cast<float>(lux / std::max(0.0, 1 + change)); }

template <typename Count>
void add(Count& sum, int hours) {
  sum = static_cast<Count>(sum + hours);
}

double percent(double hours, double of) { return 100 * hours / of; }
double occupied_percent(double hours, const YearRules& rules) { return percent(hours, rules.occupied_hours); }

/// Share [%] of the area of points that have it.
template <typename Has>
double area_share(std::span<const PointYear> points, std::span<const double> weight, double area, const Has& has) {
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (has(points[i])) sum += weight[i];
  return percent(sum, area);
}

}  // namespace

YearRules year_rules(std::span<const int> hours, std::span<const double> diffuse,
                     std::span<const std::uint8_t> is_occupied, double threshold, std::vector<double> more_thresholds) {
  CLERESTORY_ASSERT(hours.size(), ==, diffuse.size());
  CLERESTORY_ASSERT(is_occupied.size(), ==, kHoursOfYear);
  CLERESTORY_ASSERT(more_thresholds.size(), <=, kMostThresholds);
  const std::size_t H = hours.size();
  YearRules rules{.occupied = std::vector<float>(H),
                  .daylight = std::vector<float>(H),
                  .occupied_hours = static_cast<int>(std::ranges::count_if(is_occupied, [](auto o) { return o != 0; })),
                  .threshold = threshold,
                  .more_thresholds = std::move(more_thresholds)};
  for (std::size_t h = 0; h < H; ++h) rules.occupied[h] = is_occupied[static_cast<std::size_t>(hours[h])] ? 1 : 0;
  std::vector<std::size_t> order(H);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return diffuse[a] > diffuse[b]; });
  order.resize(std::min(H, kDaylightHours));
  for (const std::size_t h : order) rules.daylight[h] = 1;
  return rules;
}

PointYear figures_of(std::span<const float> total, std::span<const float> direct, const YearRules& rules,
                     const YearError& error) {
  const std::size_t H = total.size();
  CLERESTORY_ASSERT(H, ==, rules.occupied.size());
  CLERESTORY_ASSERT(direct.empty() ? H : direct.size(), ==, H);
  const std::array<float, 5> E_least = {read_for(rules.threshold, 0), read_for(rules.threshold, -error.total),
                                        read_for(rules.threshold, error.total), read_for(kUsefulLux[0], 0),
                                        just_above(read_for(kUsefulLux[1], 0))};
  const std::array<float, 3> sun_least = {just_above(read_for(kSunLux, 0)),
                                          just_above(read_for(kSunLux, -error.direct)),
                                          just_above(read_for(kSunLux, error.direct))};
  std::array<float, 4> en_least{};
  std::ranges::transform(kEn17037Lux, en_least.begin(), [](double lux) { return read_for(lux, 0); });
  PointYear year;
  float x[kChunk];
  // Hours that do not count become dark: they reach no threshold.
  const auto take = [&](std::span<const float> lux, const std::vector<float>& mask, std::size_t begin, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) x[i] = lux[begin + i] * mask[begin + i];
  };
  for (std::size_t begin = 0; begin < H; begin += kChunk) {
    const std::size_t n = std::min(kChunk, H - begin);
    take(total, rules.occupied, begin, n);
    const auto E_hours = count_at_least(x, n, E_least);
    add(year.DA, E_hours[0]), add(year.DA_low, E_hours[1]), add(year.DA_high, E_hours[2]);
    add(year.UDI_lit, E_hours[3]), add(year.UDI_upper, E_hours[4]);
    for (std::size_t k = 0; k < rules.more_thresholds.size(); ++k)
      add(year.at_least[k], count_at_least<1>(x, n, {read_for(rules.more_thresholds[k], 0)})[0]);
    add_sums(x, n, E_least[0], year);
    take(total, rules.daylight, begin, n);
    const auto en_hours = count_at_least(x, n, en_least);
    for (std::size_t k = 0; k < en_hours.size(); ++k) add(year.EN17037[k], en_hours[k]);
    if (direct.empty()) continue;
    take(direct, rules.occupied, begin, n);
    const auto sun_hours = count_at_least(x, n, sun_least);
    add(year.ASE, sun_hours[0]), add(year.ASE_low, sun_hours[1]), add(year.ASE_high, sun_hours[2]);
  }
  year.cDA /= rules.threshold;
  return year;
}

std::string threshold_name(double lux) {
  std::string digits = std::to_string(lux);
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return digits;
}

std::vector<YearFigure> year_figures(const YearRules& rules) {
  using P = const PointYear&;
  using R = const YearRules&;
  using I = std::size_t;
  const std::string T = threshold_name(rules.threshold);
  std::vector<YearFigure> figures = {
      {"DA_" + T, "%", [](P p, R r, I) { return occupied_percent(p.DA, r); }},
      {"cDA_" + T, "%", [](P p, R r, I) { return occupied_percent(p.cDA, r); }},
      {"UDI_lower", "%", [](P p, R r, I) { return occupied_percent(r.occupied_hours - p.UDI_lit, r); }},
      {"UDI", "%", [](P p, R r, I) { return occupied_percent(p.UDI_lit - p.UDI_upper, r); }},
      {"UDI_upper", "%", [](P p, R r, I) { return occupied_percent(p.UDI_upper, r); }},
      {"ASE_hours", "h", [](P p, R, I) { return double{1} * p.ASE; }},
      {"mean_illuminance", "lx", [](P p, R r, I) { return p.lux_hours / r.occupied_hours; }}};
  for (std::size_t k = 0; k < kEn17037Lux.size(); ++k)
    figures.push_back({"EN17037_" + threshold_name(kEn17037Lux[k]), "%",
                       [](P p, R, I i) { return percent(p.EN17037[i], double{kDaylightHours}); }, k});
  for (std::size_t k = 0; k < rules.more_thresholds.size(); ++k)
    figures.push_back({"hours_" + threshold_name(rules.more_thresholds[k]), "h",
                       [](P p, R, I i) { return double{1} * p.at_least[i]; }, k});
  return figures;
}

AreaYear area_year(std::span<const PointYear> points, std::span<const double> weight, const YearRules& rules) {
  CLERESTORY_ASSERT(points.size(), ==, weight.size());
  AreaYear year;
  for (std::size_t i = 0; i < points.size(); ++i) {
    year.area += weight[i];
    year.mean += weight[i] * points[i].lux_hours / rules.occupied_hours;
  }
  year.mean /= year.area;
  const auto share = [&](const auto& has) { return area_share(points, weight, year.area, has); };
  const auto half = [&](int hours) { return 2 * hours >= rules.occupied_hours; };
  year.sDA = {share([&](const PointYear& p) { return half(p.DA); }),
              share([&](const PointYear& p) { return half(p.DA_low); }),
              share([&](const PointYear& p) { return half(p.DA_high); })};
  const auto sunny = [&](int least) {
    return ShareWithin{share([&](const PointYear& p) { return p.ASE >= least; }),
                       share([&](const PointYear& p) { return p.ASE_low >= least; }),
                       share([&](const PointYear& p) { return p.ASE_high >= least; })};
  };
  year.ASE_at_least = sunny(kSunHours);
  year.ASE_more_than = sunny(kSunHours + 1);
  const auto has_for_half = [&](std::size_t lux) {
    return share([&](const PointYear& p) { return 2u * p.EN17037[lux] >= kDaylightHours; });
  };
  constexpr std::size_t kTarget[3] = {1, 2, 3}, kMinimum[3] = {0, 1, 2};  // of kEn17037Lux: 300/100, 500/300, 750/500
  for (std::size_t level = 0; level < 3; ++level) {
    year.target_share[level] = has_for_half(kTarget[level]);
    year.minimum_share[level] = has_for_half(kMinimum[level]);
    if (reaches_share(year.target_share[level], 50) && reaches_share(year.minimum_share[level], 95))
      year.level = static_cast<En17037Level>(level + 1);
  }
  return year;
}

}  // namespace clerestory
