#include "solver/visibility/glossy_sides.h"

#include <algorithm>

#include "solver/model/assert.h"
#include "solver/visibility/turning_planes.h"

namespace clerestory {

GlossySides::GlossySides(const PatchSet& patches, double diameter) {
  std::vector<std::uint16_t> of_material(patches.materials.size(), kNone);
  std::vector<bool> used(patches.materials.size());
  for (const auto& sides : patches.side_material)
    for (const MaterialId m : sides) used[m] = true;
  for (std::size_t m = 0; m < patches.materials.size(); ++m) {
    const auto& gloss = patches.materials[m].gloss;
    if (!used[m] || !gloss || gloss->specular.is_black()) continue;
    CLERESTORY_ASSERT(lobes_.size(), <, std::size_t{kNone});
    of_material[m] = static_cast<std::uint16_t>(lobes_.size());
    lobes_.emplace_back(*gloss);
  }
  if (empty()) return;
  for (const auto& [front, back] : patches.side_material) number_.push_back({of_material[front], of_material[back]});
  plane_.assign(patches.triangle_count(), kNoPlane);
  const auto is_glossy = [&](TriangleId t) { return lobe(t, kFront) || lobe(t, kBack); };
  const bool all_narrow = std::ranges::all_of(lobes_, [](const Lobe& l) { return l.sharpness() >= kNarrow; });
  for (const TrianglesInPlane& same : largest_planes(patches, diameter, is_glossy, all_narrow)) {
    Plane plane{same.plane};
    for (const TriangleId t : same.triangles) {
      plane_[t] = static_cast<std::uint32_t>(planes_.size());
      for (const Side side : {kFront, kBack})
        if (const Lobe* of_side = lobe(t, side)) plane.sharpness = std::max(plane.sharpness, of_side->sharpness());
    }
    planes_.push_back(plane);
  }
}

}  // namespace clerestory
