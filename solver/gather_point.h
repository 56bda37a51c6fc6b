#pragma once
// Final gather: irradiance at one point, from lights and a solved radiosity.

#include "solver/lights/illumination.h"

namespace clerestory {

/// How many rays a point gets. Defaults suit a sensor.
struct GatherQuality {
  int grid = 32;       ///< the hemisphere is a grid x grid of strata, a multiple of 4
  int rays = 3072;     ///< that count, at least grid x grid; the surplus goes where the pilot saw differences
  int lamp_rays = 64;  ///< shadow rays to bright patches, a multiple of 16
  int sun_rays = 16;   ///< to each sun
};

/// Irradiance [W/m2] at p (lifted) on a plane of unit normal n.
///
/// Luminaires and sun by shadow rays; bright patches, glowing or lit, by shadow rays and by the bundle, weighted by the
/// balance heuristic. For the rest a pilot sends one ray into each stratum, only to see where its neighbours differ;
/// then fresh rays, at least one a stratum, look up B (or the sky) where they land. The pilot's values are thrown away:
/// an adaptive sum that keeps them is biased.
///
/// light  made with the radiosity B of the patches.
/// key    of the random stream.
Spectrum gather_point(const Illumination& light, const Vec3& p, const Vec3& n, const GatherQuality& quality,
                      std::uint64_t key, unsigned long long& rays);

}  // namespace clerestory
