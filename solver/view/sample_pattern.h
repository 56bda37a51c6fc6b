#pragma once
// Where the rays of a pixel go through it.

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

namespace clerestory {

/// n points of the unit square, one in each of n columns and n rows, the rows in the order of van der Corput's
/// sequence; their mean is the middle.
inline std::vector<std::array<double, 2>> sample_pattern(std::size_t n) {
  const auto reversed = [](std::size_t k) {
    double value = 0, digit = 0.5;
    for (; k > 0; k /= 2, digit /= 2) value += digit * static_cast<double>(k % 2);
    return value;
  };
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, reversed);
  std::vector<std::array<double, 2>> points(n);
  const auto middle = [&](std::size_t k) { return (static_cast<double>(k) + 0.5) / static_cast<double>(n); };
  for (std::size_t row = 0; row < n; ++row) points[order[row]] = {middle(order[row]), middle(row)};
  return points;
}

}  // namespace clerestory
