#pragma once
// Final gather: irradiance at one point, from lights and a solved radiosity.

#include <cstdint>
#include <vector>

#include "solver/illumination/illumination.h"
#include "solver/sampling/gather_pattern.h"

namespace clerestory {

/// Irradiance [W/m2] at a point.
struct GatheredLight {
  Spectrum E;            ///< from everything
  Spectrum delta_light;  ///< from luminaires and suns, by shadow rays only; part of E
  double std_error = 0;  ///< of E, luminous mean, by the differences of the bundle's neighbouring rays
};

/// Rays for each stratum as powers of 2: where a pilot's ray and its neighbours' come back alike, the least. Empty: the
/// least everywhere.
using RayShares = std::vector<std::uint8_t>;

/// Where a point looks, as pilot rays tell. Their values are used for nothing else, as an adaptive sum that keeps them
/// is biased; the plan serves points nearby too.
struct GatherPlan {
  RayShares bundle;
  double delta_light = 0;  ///< at its point, luminous mean [W/m2]: it needs no care for what is little beside that
  bool looks_for_bright_patches = true;  ///< by shadow rays; else bright patches are left to the bundle
  std::vector<std::uint32_t> mirrors;    ///< planes (RayScene::mirrors) in which bright patches are looked for, too
  int rays_in_mirror = 0;                ///< shadow rays to what each of them shows
  std::vector<std::uint32_t> openings, bright_areas;       ///< looked at by rays of their own
  std::vector<AreaPlan> opening_plans, bright_area_plans;  ///< of each of them; values are pi times the radiance [W/m2]
};

/// Where no sky looks in, bright patches are the sharpest contrast, and those have rays of their own.
bool wants_plan(const Illumination& light, const GatherPattern& pattern);
GatherPlan plan_gather(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                       unsigned long long& rays);
/// More rays where neighbours of a pilot's differ; of that plan, which has none of its own.
RayShares plan_bundle(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                      const GatherPlan& plan, unsigned long long& rays);

/// Lobes are half as wide again as what they show, at the least: they need more rays than the sun's disc.
inline DeltaEffort delta_effort(const GatherPattern& pattern) {
  return {.sun_rays = pattern.quality().sun_rays, .gloss_rays = 3 * pattern.quality().sun_rays};
}

/// Irradiance at p (lifted) on a plane of unit normal n.
///
/// Luminaires and sun by shadow rays. What lies behind the openings of the plan by rays through them, and its bright
/// areas by rays at them, and by nothing else: a ray belongs to the first of the openings that it passes, else to the
/// bright area that it meets. Only what differs from the mean that the plan knows is left to chance: form factors times
/// that mean are closed forms, so an even sky or bright area that nothing hides is exact. Other bright patches, glowing
/// or lit, by shadow rays and by the bundle, weighted by the balance heuristic, and so are those that the plan's
/// mirrors show; the rest by the bundle, which looks up B (or the sky) where its rays land. Where the bundle
/// is noisier than the quality allows, it is sent anew, with more rays where a pilot sees contrast: under a bed, in a
/// gap. What less than one ray of the bundle finds seldom looks noisy: where it is all the light there is, E is low by
/// a sixth in the mean, within a standard error as large as itself.
///
/// light  made with the radiosity B of the patches.
/// plan   from plan_gather() at this point or near it.
/// row    null, or replaced by what was found, for other light: times this light it is E, but where the rays to an area
///        found little of the mean that the plan knows, and where `light` knows more of patches than their mean.
GatheredLight gather_point(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                           const GatherPlan& plan, unsigned long long& rays, LightRow* row = nullptr);

/// The same with a plan of its own, where it wants one.
GatheredLight gather_point(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                           unsigned long long& rays, LightRow* row = nullptr);

/// What layers give at a point where `at` is what they give together and `row` what was found: luminaires and suns
/// exactly, all other light so that it sums to what is left.
///
/// all, delta_light  lanes, added to `weight` times.
void add_layers(const GatheredLight& at, const LightRow& row, const RowLight& layers, double weight,
                std::span<double> all, std::span<double> delta_light);

}  // namespace clerestory
