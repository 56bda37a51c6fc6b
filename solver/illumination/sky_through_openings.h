#pragma once
// The sky as patches see it through openings.

#include <cstdint>
#include <vector>

#include "solver/illumination/illumination.h"
#include "solver/illumination/light_rows.h"

namespace clerestory {

inline constexpr int kRaysOfOpening = 32;  ///< of a patch, through each opening that it looks through

/// Mean irradiance [W/m2] of a patch by the sky through the openings that matter there, from points all over the patch.
///
/// key        of its rays
/// looked_at  set to those that any of a few rays left by, whatever the sky there; light through the others is left to
///            bundles. None where much of the sky is in view.
/// row        null, or where to add what is found
Spectrum sky_through_openings(const Illumination& light, std::size_t patch, std::uint64_t key,
                              std::vector<std::uint32_t>& looked_at, LightRow* row);

}  // namespace clerestory
