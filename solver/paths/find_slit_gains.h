#pragma once
// Paths tell how bright it is right behind the slits.

#include <cstdint>

#include "solver/illumination/illumination.h"
#include "solver/model/monitor.h"

namespace clerestory {

/// B: radiosity of the patches (N x channels), which elements look up. Lines through all points of each slit, out to
/// the bright side, and a path from where each of them ends: at most 16,384 in all. Empty without slits.
/// monitor  looked at between paths, which may be long; when it stops, what was found so far counts.
SlitGains find_slit_gains(const Problem& problem, const Field& B, std::uint64_t seed, const Monitor& monitor = {});

/// gather_illumination() that knows them.
Illumination gather_illumination_by_slits(const Problem& problem, const Field& B, std::uint64_t seed,
                                          const Monitor& monitor = {});

}  // namespace clerestory
