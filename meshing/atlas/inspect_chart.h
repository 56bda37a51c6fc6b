#pragma once
// What a chart's texels say of it, before it has any.

#include <array>
#include <cstdint>
#include <vector>

#include "meshing/atlas/raster.h"
#include "meshing/atlas/triangles_across.h"
#include "solver/model/lightmap_atlas.h"
#include "solver/model/written_result.h"

namespace clerestory {

struct Inspection {
  std::uint64_t used = 0;  ///< texels that a lookup reaches, and those around them
  /// Places in the chart's triangles: pairs of which a lookup would mix the light, though they do not hang together
  /// there and differ in it by more than a percent; and pairs that lie over each other. Ascending, each once.
  std::vector<std::array<std::uint32_t, 2>> to_part;
};

/// texels  corners of the chart's triangles, in its texels.
/// Cost: O(texels + triangles).
Inspection inspect_chart(const WrittenResult& result, const TrianglesAcross& across, const AtlasChart& chart,
                         const std::vector<std::array<Texel, 3>>& texels);

}  // namespace clerestory
