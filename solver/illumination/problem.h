#pragma once
// What every method works on.

#include "solver/lights/lights.h"
#include "solver/model/patch_set.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// References only: patches, rays and lights outlive it. Light positions are in the patches' local frame.
struct Problem {
  const PatchSet& patches;
  const RayScene& rays;
  const Lights& lights;
};

}  // namespace clerestory
