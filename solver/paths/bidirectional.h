#pragma once
// Paths from both ends: from the receiving point and from the lights, joined by shadow rays.

#include <cstdint>
#include <map>
#include <utility>

#include "solver/particles/emission.h"
#include "solver/paths/path_tracer.h"

namespace clerestory {

/// The irradiance at a point as trace_path() has it, of the same light and without bias, where that is noisy: light
/// that comes by reflection alone, through small openings, off bright spots. A path from the point and a particle from
/// the lights; each place of the one is joined with each of the other. All ways to find a path share its light by the
/// balance heuristic (path_balance.h). Source: Veach, "Robust Monte Carlo methods for light transport simulation",
/// 1997, chapter 10.
///
/// Mirrors and panes turn either half, and what is turned is not joined. Particles of luminaires and suns that they
/// turn first count on those ways that have an image, which shadow rays look for as well: the light of these is the
/// same for all methods. Lobes are evaluated, chosen and counted in the weights like diffuse reflection.
///
/// Thread safe.
class Bidirectional {
 public:
  /// light  outlives this.
  explicit Bidirectional(const Illumination& light);

  /// Images of luminaires and suns, by number of the light that they show and the way over planes.
  using Images = std::map<std::pair<std::uint32_t, MirrorWay>, std::uint32_t>;

  /// Arguments as of trace_path().
  Spectrum trace(Vec3 p, Vec3 n, const PathStart& start, RandomStream& random, unsigned long long& rays,
                 const Monitor& monitor = {}) const;
  /// trace() for whoever takes any; this outlives it.
  PathEstimator estimator() const;

 private:
  const Illumination& light_;
  RayScene scene_;  ///< without gloss
  Images images_;
  Emission emission_;
};

}  // namespace clerestory
