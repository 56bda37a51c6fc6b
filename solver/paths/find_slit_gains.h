#pragma once
// Paths tell how bright it is right behind the slits.

#include <cstdint>

#include "solver/illumination/illumination.h"
#include "solver/model/monitor.h"
#include "solver/model/slit_light.h"

namespace clerestory {

/// Lines through all points of each slit, out to the bright side, and a path from where each of them ends: at most
/// 16,384 in all. Of any elements on the same patches. Empty without slits.
/// monitor  looked at between paths, which may be long; when it stops, what was found so far counts.
SlitLight find_slit_light(const Problem& problem, std::uint64_t seed, const Monitor& monitor = {});

/// B: radiosity of the patches (N x channels), which elements look up; light, seed: of find_slit_light(). Empty without
/// slits.
SlitGains slit_gains(const Problem& problem, const Field& B, const SlitLight& light, std::uint64_t seed);

/// gather_illumination() that knows them. known: of a former call with the same seed, or empty; what was found else.
Illumination gather_illumination_by_slits(const Problem& problem, const Field& B, const SlitLight& known,
                                          std::uint64_t seed, const Monitor& monitor = {});

}  // namespace clerestory
