#include "solver/evaluate/measured_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>

#include "solver/gather/gather.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/paths/path_tracer.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

constexpr int kFewestPaths = 64;          ///< a point, for a standard error that means something
constexpr int kPilotPaths = 8;            ///< at each of the fewest points, to learn how long paths are
constexpr std::size_t kFewestPoints = 8;  ///< in rooms so bright that paths hardly end
constexpr std::size_t kMostPoints = 1 << 12;

constexpr double kShareOfRays = 0.1;  ///< of those that the result took

}  // namespace

MeasuredError summarise(std::span<const Comparison> samples) {
  MeasuredError error;
  error.samples = samples.size();
  if (samples.empty()) return error;
  const double n = static_cast<double>(samples.size());
  double mean = 0, squares = 0, variance_of_references = 0;
  for (const Comparison& s : samples) mean += s.r / n;
  if (!std::isfinite(mean)) throw std::logic_error("a reference of the measured error is no number");
  if (!(mean > 0)) return {};  // in the dark there is nothing to be wrong about
  std::vector<double> relative;
  for (const Comparison& s : samples) {
    squares += (s.x - s.r) * (s.x - s.r) / n;
    variance_of_references += s.std_error * s.std_error / n;
    // Points much darker than the mean would make a share of nothing.
    relative.push_back(std::abs(s.x - s.r) / std::max(s.r, 0.05 * mean));
  }
  double spread = 0;
  for (const Comparison& s : samples) {
    const double d2 = (s.x - s.r) * (s.x - s.r) - s.std_error * s.std_error - (squares - variance_of_references);
    spread += d2 * d2 / n;
  }
  // The reference's own noise adds to the differences; its variance is known and comes off.
  const double variance_of_field = std::max(squares - variance_of_references, 0.0);
  const double half_width = 1.96 * std::sqrt(spread / n);  // of the mean square
  error.rms_relative = std::sqrt(variance_of_field) / mean;
  error.confidence = (std::sqrt(variance_of_field + half_width) - std::sqrt(variance_of_field)) / mean;
  // Right when errors are distributed like the noise, and too large when few large errors make up the variance. A
  // distribution fitted to what lies behind the noise was tried: it took tails for noise and was low by a quarter.
  const auto p95 = relative.begin() + static_cast<std::ptrdiff_t>(0.95 * (n - 1));
  std::nth_element(relative.begin(), p95, relative.end());
  error.p95_relative = *p95 * (squares > 0 ? std::sqrt(variance_of_field / squares) : 1.0);
  return error;
}

namespace {

struct References {
  std::vector<Comparison> at;  ///< those that were finished
  unsigned long long rays = 0;
  bool complete = false;
};

/// Traces paths for references at the places of samples whose x is set, as many as the effort allows. Stopped by the
/// monitor, it takes those that are there.
MeasuredError compare(const Problem& problem, const std::vector<Comparison>& samples, const PointOf& point_of,
                      const ErrorEffort& effort, unsigned long long rays_spent, std::uint64_t key,
                      const Monitor& monitor) {
  const Illumination light(problem);
  // In parts, not by points: where paths have millions of bounces there are few points, and each takes a minute.
  const auto trace = [&](std::size_t count, std::uint64_t stream, int paths, const auto& sample_of) {
    std::vector<Spectrum> mean(count * kReplicates);
    std::vector<char> finished(count * kReplicates);
    constexpr std::size_t kBlock = 32 * kReplicates;
    const auto blocks =
        parallel_blocks(mean.size(), kBlock, 1, "error", monitor, [&](std::size_t from, std::size_t to) {
          unsigned long long rays = 0;
          for (std::size_t t = from; t < to; ++t) {
            const std::size_t i = sample_of(t / kReplicates);
            const auto [p, n] = point_of(i);
            mean[t] = trace_replicate(light, p, n, stream_key(stream, i), t % kReplicates, paths, rays, monitor);
            finished[t] = !monitor.should_stop();
          }
          return rays;
        });
    References references{{}, blocks.rays, blocks.done == mean.size()};
    for (std::size_t k = 0; k < count; ++k) {
      const auto first = static_cast<std::ptrdiff_t>(k * kReplicates);
      if (std::count(finished.begin() + first, finished.begin() + first + std::ptrdiff_t{kReplicates}, 0) > 0) continue;
      const auto [E, std_error] =
          estimate_of(std::span<const Spectrum, kReplicates>(&mean[k * kReplicates], kReplicates));
      references.at.push_back({samples[sample_of(k)].x, luminous_mean(E), luminous_mean(std_error)});
    }
    return references;
  };

  const std::size_t step = samples.size() / kFewestPoints + 1, pilots = (samples.size() + step - 1) / step;
  const References pilot = trace(pilots, key + 1, kPilotPaths, [&](std::size_t k) { return k * step; });
  if (!pilot.complete) return summarise(pilot.at);
  const double rays_per_path = static_cast<double>(pilot.rays) / static_cast<double>(pilots * kPilotPaths);
  const double affordable =  // paths in all
      std::max(kShareOfRays * static_cast<double>(rays_spent), effort.rays) / rays_per_path;
  const double points = static_cast<double>(std::min(samples.size(), effort.points));
  const int paths = std::clamp(static_cast<int>(affordable / points), kFewestPaths, effort.paths);
  const auto count = std::min(samples.size(), std::max(kFewestPoints, static_cast<std::size_t>(affordable / paths)));
  const References all = trace(count, key, paths, [&](std::size_t k) { return k * samples.size() / count; });
  return summarise(all.at.size() < pilot.at.size() ? pilot.at : all.at);
}

}  // namespace

MeasuredError measure_error(const Problem& problem, const VertexLightmap& lightmap, const ErrorEffort& effort,
                            unsigned long long rays_spent, std::uint64_t seed, const Monitor& monitor) {
  const PatchSet& patches = problem.patches;
  std::vector<double> cumulative(patches.patch_count());
  double area = 0;
  for (std::size_t i = 0; i < cumulative.size(); ++i) cumulative[i] = area += patches.area[i];
  if (!(area > 0)) return {};

  std::vector<Comparison> samples(kMostPoints);
  std::vector<ReceivingPoint> places(kMostPoints);
  RandomStream random(seed, kErrorPoints);
  for (std::size_t s = 0; s < kMostPoints; ++s) {
    const double at = (static_cast<double>(s) + random.uniform()) / static_cast<double>(kMostPoints) * area;
    const auto found = std::upper_bound(cumulative.begin(), cumulative.end(), at);
    const std::size_t i =
        std::min<std::size_t>(static_cast<std::size_t>(found - cumulative.begin()), cumulative.size() - 1);
    const double u = random.uniform(), v = random.uniform();
    // The map is linear in the corners, so it interpolates their values as well as their positions.
    const auto weight = point_on_triangle({Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, u, v);
    for (int k = 0; k < 3; ++k)
      samples[s].x += weight[k] * luminous_mean(lightmap.E[lightmap.corners[i][static_cast<std::size_t>(k)]]);
    places[s] = {
        problem.rays.off_surface(point_on_triangle(patches.corner_positions(PatchId{i}), u, v), patches.normal[i]),
        patches.normal[i]};
  }
  return compare(
      problem, samples, [&](std::size_t i) { return places[i]; }, effort, rays_spent, stream_key(seed, kErrorPaths),
      monitor);
}

MeasuredError measure_sensor_error(const Problem& problem, std::span<const SensorPoint> points, const Field& E,
                                   const ErrorEffort& effort, unsigned long long rays_spent, std::uint64_t seed,
                                   const Monitor& monitor) {
  const std::size_t count = std::min(points.size(), kMostPoints);
  if (count == 0) return {};
  const auto number_of = [&](std::size_t s) { return s * points.size() / count; };
  std::vector<Comparison> samples(count);
  for (std::size_t s = 0; s < count; ++s) samples[s].x = luminous_mean(E[number_of(s)]);
  const PointOf point_of = sensor_points(points, problem.patches.origin, problem.rays);
  return compare(
      problem, samples, [&](std::size_t s) { return point_of(number_of(s)); }, effort, rays_spent,
      stream_key(seed, kSensorErrorPaths), monitor);
}

}  // namespace clerestory
