#pragma once
// Final gather: irradiance at one point, from lights and a solved radiosity.

#include <cstdint>
#include <vector>

#include "solver/gather_pattern.h"
#include "solver/lights/illumination.h"

namespace clerestory {

/// Irradiance [W/m2] at a point.
struct PointLight {
  Spectrum E;             ///< from everything
  Spectrum small_lights;  ///< from luminaires without extent and suns; part of E
  double noise = 0;  ///< standard error of E from the bundle, luminous mean, by the differences of neighbouring rays
};

/// Where no sky looks in, bright patches are the sharpest contrast, and those have rays of their own.
bool wants_pilot(const Illumination& light, const GatherPattern& pattern);

/// Rays for each stratum as powers of 2: where a pilot's ray and its neighbours' come back alike, the least. A pilot's
/// values are used for nothing else, as an adaptive sum that keeps them is biased; its choice serves points nearby too.
using RayShares = std::vector<std::uint8_t>;
RayShares share_rays(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                     unsigned long long& rays);

/// Irradiance at p (lifted) on a plane of unit normal n.
///
/// Luminaires and sun by shadow rays; bright patches, glowing or lit, by shadow rays and by the bundle, weighted by the
/// balance heuristic. The rest by a bundle that looks up B (or the sky) where its rays land.
///
/// light   made with the radiosity B of the patches.
/// shares  from share_rays() at this point or near it; empty: the least everywhere.
PointLight gather_point(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                        const RayShares& shares, unsigned long long& rays);

/// The same with a pilot of its own, where it wants one.
PointLight gather_point(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                        unsigned long long& rays);

}  // namespace clerestory
