#pragma once
// The lights of a problem, ready to be sampled.

#include "solver/lights/light_sampler.h"
#include "solver/lights/opening_sampler.h"
#include "solver/lights/sky.h"
#include "solver/problem.h"

namespace clerestory {

struct Illumination {
  const Problem& problem;
  LightSampler lamps;
  SkyRadiance sky;
  OpeningSampler openings;

  explicit Illumination(const Problem& p) : Illumination(p, p.patches.M) {}
  /// glow: see LightSampler; outlives this.
  Illumination(const Problem& p, const Field& glow) : problem(p), lamps(p, glow), sky(p.lights), openings(p) {}
};

}  // namespace clerestory
