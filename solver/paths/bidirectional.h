#pragma once
// Paths from both ends: from the receiving point and from the lights, joined by shadow rays.

#include "solver/particles/emission.h"
#include "solver/paths/path_tracer.h"

namespace clerestory {

/// The irradiance at a point as trace_path() has it, of the same light and without bias, where that is noisy: light
/// that comes by reflection alone, through small openings, off bright spots. A path from the point and a particle from
/// the lights; each place of the one is joined with each of the other. All ways to find a path share its light by the
/// balance heuristic (path_balance.h). Source: Veach, "Robust Monte Carlo methods for light transport simulation",
/// 1997, chapter 10.
///
/// Mirrors and panes turn either half, and what is turned is not joined. Luminaires and suns are met over them by
/// shadow rays to their images alone: the light of those is the same for all methods.
///
/// Thread safe.
class Bidirectional {
 public:
  /// light  outlives this.
  explicit Bidirectional(const Illumination& light)
      : light_(light), scene_(light.problem.rays.without_gloss()), emission_(light) {}

  /// Arguments as of trace_path().
  Spectrum trace(Vec3 p, Vec3 n, const PathStart& start, RandomStream& random, unsigned long long& rays,
                 const Monitor& monitor = {}) const;
  /// trace() for whoever takes any; this outlives it.
  PathEstimator estimator() const;

 private:
  const Illumination& light_;
  RayScene scene_;
  Emission emission_;
};

}  // namespace clerestory
