#pragma once
// The lights of a problem, ready to be sampled.

#include "solver/lights/light_sampler.h"
#include "solver/lights/opening_sampler.h"
#include "solver/lights/panels.h"
#include "solver/lights/sky.h"
#include "solver/problem.h"

namespace clerestory {

struct Illumination {
  const Problem& problem;
  LightSampler lamps;
  SkyRadiance sky;
  OpeningSampler openings;
  Panels panels{};  ///< for a gather; see look_at_panels()

  explicit Illumination(const Problem& p) : Illumination(p, p.patches.M) {}
  /// glow: see LightSampler; outlives this.
  Illumination(const Problem& p, const Field& glow) : problem(p), lamps(p, glow), sky(p.lights), openings(p) {}
  /// Lets a gather look at bright patches that lie together as one.
  void look_at_panels() { panels = find_panels(problem.patches, lamps); }
};

}  // namespace clerestory
