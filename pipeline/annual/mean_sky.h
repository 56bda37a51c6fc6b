#pragma once
// The light of a year as one sky, which elements and rays are fitted to.

#include "solver/annual/year_light.h"
#include "solver/model/light_spec.h"
#include "solver/model/scene.h"

namespace clerestory {

/// The mean of all hours in which it is counted; the sun's light is spread over the part of the sky that it stands in.
///
/// counts  H, weights of the hours, some of them above 0.
Sky mean_sky(std::span<const DaylightHour> hours, std::span<const float> counts, const YearLight& year,
             const SkyParts& coarse);

/// The scene with that sky alone: lamps, glowing surfaces and its own daylight are off.
Scene under_sky(const Scene& scene, Sky sky);

}  // namespace clerestory
