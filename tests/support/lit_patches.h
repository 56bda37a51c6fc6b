#pragma once
// Patches with what a light sampler needs around them.

#include <utility>

#include "solver/illumination/light_sampler.h"
#include "solver/illumination/near_luminaires.h"

namespace clerestory::test {

struct LitPatches {
  explicit LitPatches(PatchSet set, Lights with = {})
      : patches(std::move(set)), rays(patches), lights(std::move(with)) {
    find_near_planes(lights, patches, rays);
  }
  PatchSet patches;
  RayScene rays;
  Lights lights;
  Problem problem{patches, rays, lights};
  LightSampler sampler{problem, patches.M};
};

}  // namespace clerestory::test
