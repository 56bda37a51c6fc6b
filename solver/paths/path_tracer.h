#pragma once
// One random path: the unbiased estimate that judges all other methods.

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <utility>

#include "solver/illumination/illumination.h"
#include "solver/model/monitor.h"
#include "solver/model/point_irradiance.h"
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

/// Numbers in [0, 1) that a path starts with, stratified over the paths by the caller.
struct PathStart {
  std::array<double, 2> direction;  ///< of the first ray
  std::array<double, 3> light;      ///< choice and point of the light that shines on the first point
  std::array<double, 3> opening;    ///< choice of an opening, and direction through it
  std::uint32_t number;             ///< of the path, and the key of all of them: for those who want more
  std::uint64_t key;
};
/// That of path k; directions are given, for callers that also spread the points.
PathStart path_start(const std::array<double, 2>& direction, std::uint32_t k, std::uint64_t key);

/// Irradiance [W/m2] at point p (lifted) with unit normal n, by one path of any length:
///   E(x) = lights(x) + sky + sum over bounces of the product of rho times the same at the next point
/// A light is chosen for a shadow ray at every bounce, and an opening for one at the sky; glowing patches and that sky
/// are met by scattered rays as well, weighted by the balance heuristic (Veach & Guibas 1995). Russian roulette ends
/// paths that carry little, so there is no bias; it comes after the shadow ray and late, because ending a path in two
/// halves and doubling the other is most of the noise.
///
/// rays     is raised by the rays traced.
/// monitor  asked now and then, for a path may have millions of bounces. Ask it, too: a path that it stopped is worth
///          nothing.
Spectrum trace_path(const Illumination& light, Vec3 p, Vec3 n, const PathStart& start, RandomStream& random,
                    unsigned long long& rays, const Monitor& monitor = {});

/// The same by whatever paths: trace_path() where it is made of an Illumination, which outlives it.
class PathEstimator {
 public:
  using Trace = std::function<Spectrum(const Vec3& p, const Vec3& n, const PathStart& start, RandomStream& random,
                                       unsigned long long& rays, const Monitor& monitor)>;

  PathEstimator(const Illumination& light);
  /// channels: of the patches.
  PathEstimator(int channels, Trace trace) : channels_(channels), trace_(std::move(trace)) {}

  int channels() const { return channels_; }

  Spectrum operator()(const Vec3& p, const Vec3& n, const PathStart& start, RandomStream& random,
                      unsigned long long& rays, const Monitor& monitor) const {
    return trace_(p, n, start, random, rays, monitor);
  }

 private:
  int channels_;
  Trace trace_;
};

/// Irradiance at the fixed point p and its standard error, from independent replicates of stratified paths: the spread
/// between replicates counts what stratification gains, which the spread of single paths does not.
struct PathEstimate {
  Spectrum E, std_error;
};
inline constexpr std::size_t kReplicates = 8;
PathEstimate trace_paths_at_point(const PathEstimator& estimator, const Vec3& p, const Vec3& n, std::uint64_t key,
                                  int paths, unsigned long long& rays, const Monitor& monitor = {});

/// The same in parts, for a loop over them: the mean of replicate r < kReplicates, and what all of them say.
Spectrum trace_replicate(const PathEstimator& estimator, const Vec3& p, const Vec3& n, std::uint64_t key, std::size_t r,
                         int paths, unsigned long long& rays, const Monitor& monitor = {});
PathEstimate estimate_of(std::span<const Spectrum, kReplicates> replicates);

/// The same at each of `count` places.
PointIrradiance trace_paths_at(const PathEstimator& estimator, std::size_t count, const PointOf& point_of, int paths,
                               std::uint64_t key, std::string_view stage, const Monitor& monitor = {});

}  // namespace clerestory
