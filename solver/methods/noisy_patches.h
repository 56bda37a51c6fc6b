#pragma once
// Patches that a shot's rays seldom meet.

#include <cstdint>

#include "solver/illumination/problem.h"
#include "solver/model/monitor.h"
#include "solver/model/solution.h"
#include "solver/sampling/gather_pattern.h"

namespace clerestory {

/// Shooting counts rays, so a patch that n of them met is known to 1 / sqrt(n): slivers and dark corners stay noisy.
/// Where fewer than `fewest` are to be expected, E and B are gathered anew, at a random point of the patch, from the
/// shot solution. The energy balance stays that of the shooting.
///
/// returns  the number of patches gathered.
std::size_t gather_noisy_patches(const Problem& problem, Solution& solution, double fewest,
                                 const GatherQuality& quality, std::uint64_t seed, const Monitor& monitor = {});

}  // namespace clerestory
