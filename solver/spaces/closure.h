#pragma once
// How closed the scene is around each patch, and which patches share a space.

#include <cstdint>
#include <vector>

#include "solver/illumination/problem.h"
#include "solver/model/monitor.h"

namespace clerestory {

/// Shares of what a patch sends out, N x channels. A uniform radiosity e of everything gives patch i the irradiance
/// arrives_i e. The rest of 1 - arrives - escapes is absorbed by glass and sides that take no part.
struct Closure {
  Field arrives;                     ///< at other patches
  Field escapes;                     ///< out of the scene
  std::vector<std::uint32_t> space;  ///< N, number of the space that patch i is in, 0 .. spaces - 1
  std::size_t spaces = 0;
  unsigned long long rays = 0;
  bool has_gloss = false;  ///< shares that arrive may sum to more than 1
  bool complete = true;    ///< false when the monitor stopped the work: nothing of it is to be used
};

/// By rays_per_patch (at least 8) stratified cosine rays; exactly 1 and 0 in a closed room without glass. What sees
/// each other through slits only is not one space: light that is even outdoors is not so in a dark room behind a slit.
Closure measure_closure(const Problem& problem, int rays_per_patch, std::uint64_t seed, const Monitor& monitor = {});

}  // namespace clerestory
