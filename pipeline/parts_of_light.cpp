#include "pipeline/parts_of_light.h"

#include "solver/lights/layers_of_times.h"

namespace clerestory {

std::vector<Layer> parts_of_light(const Scene& scene, const Settings& settings, const Lights& lights,
                                  const PatchSet& patches) {
  if (!scene.times.empty()) return layers_of_times(lights, patches);
  return settings.layers ? layers_by_group(lights, patches) : std::vector<Layer>{};
}

}  // namespace clerestory
