#pragma once
// Patches with what a light sampler needs around them.

#include <utility>

#include "solver/illumination/light_sampler.h"

namespace clerestory::test {

struct LitPatches {
  explicit LitPatches(PatchSet set, Lights with = {})
      : patches(std::move(set)), rays(patches), lights(std::move(with)) {}
  PatchSet patches;
  RayScene rays;
  Lights lights;
  Problem problem{patches, rays, lights};
  LightSampler sampler{problem, patches.M};
};

}  // namespace clerestory::test
