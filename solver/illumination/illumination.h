#pragma once
// The lights of a problem, ready to be sampled.

#include <functional>

#include "solver/illumination/bright_areas.h"
#include "solver/illumination/light_sampler.h"
#include "solver/illumination/problem.h"
#include "solver/lights/sky.h"
#include "solver/openings/opening_sampler.h"
#include "solver/openings/openings.h"
#include "solver/openings/slit_gains.h"

namespace clerestory {

struct Illumination {
  const Problem& problem;
  LightSampler sampler;
  SkyRadiance sky;
  OpeningSampler openings;     ///< that the sky is seen through
  OpeningSampler slits;        ///< that rays meet by chance only, and surfaces are seen through
  SlitGains slit_gains{};      ///< for a gather; see find_slit_gains()
  BrightAreas bright_areas{};  ///< for a gather; see look_at_bright_areas()
  /// For a gather: what comes back from a place on a patch, above what does from all of it [W/m2]; empty: nothing.
  std::function<Spectrum(PatchId, const Vec3&)> above_mean{};

  explicit Illumination(const Problem& p) : Illumination(p, p.patches.M) {}
  /// glow: see LightSampler; outlives this.
  Illumination(const Problem& p, const Field& glow)
      : problem(p),
        sampler(p, glow),
        sky(p.lights),
        openings({p.lights.sky_openings().begin(), p.lights.sky_openings().end()}, p.rays.diameter()),
        slits(slits_among(p.lights.openings), p.rays.diameter()) {}
  /// What comes back from x on a patch, seen from so far [W/m2]. From afar the mean of all of it tells as much.
  Spectrum glow_at(PatchId patch, const Vec3& x, double distance) const {
    constexpr double kNear = 16;  // times the area: four times as far off as it is wide
    const Spectrum mean = sampler.glow()[patch];
    if (!above_mean || distance * distance > kNear * problem.patches.area[patch]) return mean;
    return mean + above_mean(patch, x);
  }
  /// Lets a gather look at bright patches that lie together as one.
  void look_at_bright_areas() { bright_areas = find_bright_areas(problem.patches, sampler); }
};

/// For a final gather from the radiosity B (N x channels) of all patches, which outlives it: reflected light is looked
/// up, so what is bright by reflection is a lamp like others.
inline Illumination gather_illumination(const Problem& problem, const Field& B) {
  Illumination light(problem, B);
  light.look_at_bright_areas();
  return light;
}

}  // namespace clerestory
