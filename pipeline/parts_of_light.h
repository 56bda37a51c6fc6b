#pragma once
// What the light of a scene is parted into while it is solved.

#include <vector>

#include "pipeline/settings.h"
#include "solver/lights/layers.h"

namespace clerestory {

/// The times of a scene that has several, or what can be dimmed where layers are asked for; else none.
std::vector<Layer> parts_of_light(const Scene& scene, const Settings& settings, const Lights& lights,
                                  const PatchSet& patches);

}  // namespace clerestory
