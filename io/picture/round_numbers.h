#pragma once
// Numbers that are easy to read: 1, 2 and 5 times powers of ten.

#include <cmath>

namespace clerestory {

/// The smallest of them that is no less than x > 0.
inline double round_up(double x) {
  const double decade = std::pow(10.0, std::floor(std::log10(x) + 1e-9));
  for (const double step : {1.0, 2.0, 5.0})
    if (x <= step * decade * (1 + 1e-9)) return step * decade;
  return 10 * decade;
}

/// The largest that is no more than x > 0.
inline double round_down(double x) {
  const double decade = std::pow(10.0, std::floor(std::log10(x) + 1e-9));
  for (const double step : {5.0, 2.0})
    if (x >= step * decade * (1 - 1e-9)) return step * decade;
  return decade;
}

}  // namespace clerestory
