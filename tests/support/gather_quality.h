#pragma once
// Enough rays for tests of gathers.

#include "solver/sampling/gather_pattern.h"

namespace clerestory::test {

inline constexpr AreaBudget kAreaBudget{.first = 2, .last = 6, .tolerance = 0.003, .most_rays = 8192};

constexpr GatherQuality gather_quality(RayBudget bundle = {16, 1024, 4096}, int bright_rays = 128) {
  return {.bundle = bundle, .area = kAreaBudget, .bright_rays = bright_rays, .sun_rays = 16};
}

}  // namespace clerestory::test
