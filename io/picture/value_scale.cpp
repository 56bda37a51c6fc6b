#include "io/picture/value_scale.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "io/picture/round_numbers.h"

namespace clerestory {
namespace {

double quantile(std::vector<float>& values, double share) {
  const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return double{values[static_cast<std::size_t>(k)]};
}

}  // namespace

std::vector<double> ticks_of(const ValueScale& scale, int most) {
  std::vector<double> inner;
  if (scale.by_logarithm) {
    const double decades = std::log10(scale.high) - std::log10(scale.low);
    const bool all_three = 3 * decades <= most;
    const int first = static_cast<int>(std::floor(std::log10(scale.low))),
              last = static_cast<int>(std::ceil(std::log10(scale.high))),
              stride = std::max(1, static_cast<int>(std::ceil(decades / most)));
    for (int n = first; n <= last; n += all_three ? 1 : stride)
      for (const double step : {1.0, 2.0, 5.0})
        if (step == 1 || all_three) inner.push_back(step * std::pow(10.0, n));
  } else {
    const double step = round_up((scale.high - scale.low) / most);
    for (double k = std::ceil(scale.low / step); k * step < scale.high; ++k) inner.push_back(k * step);
  }
  // None so near to an end that their names would touch.
  const auto place = [&](double v) {
    return scale.by_logarithm ? std::log(v / scale.low) / std::log(scale.high / scale.low)
                              : (v - scale.low) / (scale.high - scale.low);
  };
  std::vector<double> ticks{scale.low};
  const double clearance = 0.4 / most;
  for (const double v : inner)
    if (place(v) > clearance && place(v) < 1 - clearance) ticks.push_back(v);
  ticks.push_back(scale.high);
  return ticks;
}

ValueScale scale_around(std::vector<float> values, bool by_logarithm) {
  if (by_logarithm) std::erase_if(values, [](float v) { return !(v > 0); });
  if (values.empty()) return {by_logarithm ? 0.1 : 0, 1, by_logarithm};
  const double low = quantile(values, 0.01), high = quantile(values, 0.99);
  if (by_logarithm) {
    ValueScale scale{round_down(low), round_up(high), true};
    if (!(scale.high > scale.low)) scale.high = 10 * scale.low;
    return scale;
  }
  constexpr int kSteps = 8;
  const double spread = high - low;
  if (low >= 0 && spread > 0.25 * high) {
    const double step = round_up(high / kSteps);
    return {0, step * std::ceil(high / step * (1 - 1e-9)), false};
  }
  const double size = std::max(std::abs(low), std::abs(high));
  if (!(size > 0)) return {0, 1, false};
  const double step = round_up(std::max(spread, 0.01 * size) / kSteps);
  ValueScale scale{step * std::floor(low / step), step * std::ceil(high / step), false};
  if (!(scale.high > scale.low)) scale.high = scale.low + step;
  return scale;
}

}  // namespace clerestory
