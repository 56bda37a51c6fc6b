#include "solver/model/vertex_lightmap.h"

#include "solver/model/assert.h"

namespace clerestory {

void average_to_points(const PatchSet& patches, const Field& patch_E, VertexLightmap& lightmap) {
  CLERESTORY_ASSERT(patch_E.size(), ==, patches.patch_count());
  lightmap.E = Field(lightmap.position.size(), patch_E.channels);
  std::vector<double> area(lightmap.position.size());
  for (std::size_t p = 0; p < patches.patch_count(); ++p)
    for (const std::uint32_t point : lightmap.corners[p]) {
      lightmap.E.add(point, patch_E[p] * patches.area[p]);
      area[point] += patches.area[p];
    }
  for (std::size_t i = 0; i < area.size(); ++i)
    for (int k = 0; k < patch_E.channels; ++k) lightmap.E.at(i, k) /= area[i];
}

}  // namespace clerestory
