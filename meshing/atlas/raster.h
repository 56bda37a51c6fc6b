#pragma once
// Cells of a grid that a triangle touches.

#include <algorithm>
#include <array>
#include <cmath>

namespace clerestory {

using Texel = std::array<double, 2>;  ///< a place between texel centres, in texels

/// Lookups are rounded: a triangle that comes this near to a cell reaches into it.
inline constexpr double kNearTexel = 2e-3;

/// Smallest and largest x of the triangle's part between the heights `low` and `high`; first > second: none.
inline std::array<double, 2> x_range(const std::array<Texel, 3>& corner, double low, double high) {
  std::array<double, 2> range{1e300, -1e300};
  const auto add = [&](double x) { range = {std::min(range[0], x), std::max(range[1], x)}; };
  for (std::size_t k = 0; k < 3; ++k) {
    const Texel &a = corner[k], &b = corner[(k + 1) % 3];
    if (a[1] >= low && a[1] <= high) add(a[0]);
    for (const double y : {low, high})
      if ((a[1] < y) != (b[1] < y)) add(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
  }
  return range;
}

/// Calls visit(row, first, last) for each row of cells that the triangle touches. There are columns x rows cells.
template <class Visit>
void for_rows_of_cells(const std::array<Texel, 3>& corner, int columns, int rows, const Visit& visit) {
  const auto cell = [](double x, int count) { return static_cast<int>(std::clamp(std::floor(x), 0.0, count - 1.0)); };
  const auto [low, high] = std::minmax({corner[0][1], corner[1][1], corner[2][1]});
  const int last = cell(high + kNearTexel, rows);
  for (int row = cell(low - kNearTexel, rows); row <= last; ++row) {
    const auto [left, right] = x_range(corner, row - kNearTexel, row + 1 + kNearTexel);
    if (left <= right) visit(row, cell(left - kNearTexel, columns), cell(right + kNearTexel, columns));
  }
}

}  // namespace clerestory
