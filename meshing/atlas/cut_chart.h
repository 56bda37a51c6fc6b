#pragma once
// Where a chart is cut in two.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "meshing/atlas/raster.h"

namespace clerestory {

struct ChartCut {
  double cost = 1e300;  ///< texels of both parts, and a penalty for what it leaves together
  std::size_t axis = 0, first = 0;
};

/// The cut across one of the axes that leaves the smallest rectangles: `order` gets the triangles' places by centre,
/// of which the first `first` are one part.
ChartCut best_cut(const std::vector<std::array<Texel, 3>>& texels,
                  const std::vector<std::array<std::uint32_t, 2>>& to_part, bool in_middle,
                  std::array<std::vector<std::uint32_t>, 2>& order);

}  // namespace clerestory
