#pragma once
// Patches whose triangles share vertices, as meshing leaves them.

#include <utility>
#include <vector>

#include "solver/model/patch_set.h"

namespace clerestory::test {

/// Vertices in one place made one.
inline PatchSet joined(PatchSet patches) {
  std::vector<Vec3> kept;
  std::vector<VertexId> now;
  for (const Vec3& x : patches.vertices) {
    std::size_t k = 0;
    while (k < kept.size() && length(kept[k] - x) > 1e-9) ++k;
    if (k == kept.size()) kept.push_back(x);
    now.emplace_back(k);
  }
  for (auto& corners : patches.corners)
    for (VertexId& v : corners) v = now[v];
  patches.vertices = std::move(kept);
  return patches;
}

}  // namespace clerestory::test
