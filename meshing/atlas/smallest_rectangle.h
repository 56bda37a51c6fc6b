#pragma once
// The smallest rectangle around points of a plane.

#include <array>
#include <vector>

namespace clerestory {

struct TurnedRectangle {
  std::array<double, 2> axis{1, 0};     ///< unit, along the first side; the second is turned to the left of it
  std::array<double, 2> low{}, high{};  ///< along both axes
};

/// One side lies on an edge of the convex hull.
/// Source: Freeman and Shapira, "Determining the minimum-area encasing rectangle for an arbitrary closed curve", 1975.
TurnedRectangle smallest_rectangle(std::vector<std::array<double, 2>> points);

}  // namespace clerestory
