#pragma once
// Rectangles -> places in one picture. stb_rect_pack stays inside.

#include <array>
#include <vector>

#include "solver/model/lightmap_atlas.h"

namespace clerestory {

inline constexpr int kLargestAtlas = 16384;  ///< texels; what graphics cards take

/// Gives all charts, their gutters around them, a place: sets x and y, and u, v, origin, width and height of those that
/// are turned by 90 degrees.
///
/// returns  width and height of the picture, multiples of 4, the smallest that was found; {0, 0} when nothing up to
///          kLargestAtlas is large enough: the charts are as they were then.
std::array<int, 2> pack_charts(std::vector<AtlasChart>& charts);

}  // namespace clerestory
