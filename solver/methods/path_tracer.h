#pragma once
// One random path: the unbiased estimate that judges all other methods.

#include "solver/lights/illumination.h"
#include "solver/model/random_stream.h"

namespace clerestory {

/// Mean and spread of random estimates, summed so that rounds can be added.
struct PathSum {
  Spectrum sum, sum_of_squares;
  double count = 0;

  void add(const Spectrum& x) {
    sum += x;
    sum_of_squares += x * x;
    ++count;
  }
  Spectrum mean() const { return count > 0 ? sum / count : Spectrum(0.0); }
  /// Of the mean. Stratification makes the true error smaller than this.
  Spectrum std_error() const;
};

/// Irradiance [W/m2] at point p (lifted) with unit normal n, by one path of any length:
///   E(x) = lights(x) + sky + sum over bounces of the product of rho times the same at the next point
/// A light is chosen for a shadow ray at every bounce; glowing patches are met by both ways, weighted by the balance
/// heuristic (Veach & Guibas 1995). Russian roulette ends the path with the largest throughput, so there is no bias.
///
/// u      first direction in u[0], u[1], stratified by the caller.
/// rays   is raised by the rays traced.
Spectrum trace_path(const Illumination& light, Vec3 p, Vec3 n, const std::array<double, 2>& u, RandomStream& random,
                    unsigned long long& rays);

/// Irradiance at the fixed point p and its standard error, from independent replicates of stratified paths: the spread
/// between replicates counts what stratification gains, which the spread of single paths does not.
struct PathEstimate {
  Spectrum E, std_error;
};
PathEstimate trace_paths_at_point(const Illumination& light, const Vec3& p, const Vec3& n, std::uint64_t key, int paths,
                                  unsigned long long& rays);

}  // namespace clerestory
