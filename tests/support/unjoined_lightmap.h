#pragma once
// The least that an ElementMesh needs to know of patches: nothing is joined, every patch is halved alone.

#include "solver/model/vertex_lightmap.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory::test {

inline VertexLightmap unjoined_lightmap(const PatchSet& patches) {
  constexpr std::uint32_t kNone = VertexLightmap::kNone;
  VertexLightmap map;
  map.sample_begin.push_back(0);
  for (std::uint32_t i = 0; i < patches.patch_count(); ++i) {
    map.corners.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    map.neighbour.push_back({kNone, kNone, kNone});
    for (const Vec3& c : patches.corner_positions(PatchId{std::size_t{i}})) {
      map.position.push_back(c), map.patch_of_point.push_back(i);
      map.sample_position.push_back(c), map.sample_normal.push_back(patches.normal[i]);
      map.sample_weight.push_back(1);
      map.sample_begin.push_back(static_cast<std::uint32_t>(map.sample_position.size()));
    }
  }
  return map;
}

}  // namespace clerestory::test
