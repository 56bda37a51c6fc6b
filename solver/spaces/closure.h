#pragma once
// How closed the scene is around each patch, and which patches share a space.

#include <cstdint>
#include <vector>

#include "solver/model/patch_set.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// Shares of what a patch sends out, N x channels. A uniform radiosity e of everything gives patch i the irradiance
/// arrives_i e. The rest of 1 - arrives - escapes is absorbed by glass and sides that take no part.
struct Closure {
  Field arrives;                     ///< at other patches
  Field escapes;                     ///< out of the scene
  std::vector<std::uint32_t> space;  ///< N, number of the space that patch i is in, 0 .. spaces - 1
  std::size_t spaces = 0;
  unsigned long long rays = 0;
};

/// By rays_per_patch (at least 8) stratified cosine rays; exactly 1 and 0 in a closed room without glass.
Closure measure_closure(const PatchSet& patches, const RayScene& rays, int rays_per_patch, std::uint64_t seed);

}  // namespace clerestory
