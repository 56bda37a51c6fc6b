#include "solver/evaluate/measured_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

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

constexpr double kShareOfRays = 0.05;  ///< of those that the result took

}  // namespace

MeasuredError summarise(std::span<const Comparison> samples) {
  MeasuredError error;
  error.samples = samples.size();
  if (samples.empty()) return error;
  const double n = static_cast<double>(samples.size());
  double mean = 0, squares = 0, variance_of_references = 0, weights = 0;
  for (const Comparison& s : samples) weights += s.weight / n;
  const auto share = [&](const Comparison& s) { return s.weight / weights; };  // 1 in the mean
  for (const Comparison& s : samples) mean += share(s) * s.r / n;
  if (!std::isfinite(mean)) throw std::logic_error("a reference of the measured error is no number");
  if (!(mean > 0)) return {};                       // in the dark there is nothing to be wrong about
  std::vector<std::pair<double, double>> relative;  // and its share
  for (const Comparison& s : samples) {
    squares += share(s) * (s.x - s.r) * (s.x - s.r) / n;
    variance_of_references += share(s) * s.std_error * s.std_error / n;
    // Points much darker than the mean would make a share of nothing.
    relative.push_back({std::abs(s.x - s.r) / std::max(s.r, 0.05 * mean), share(s)});
  }
  double spread = 0;
  for (const Comparison& s : samples) {
    const double d2 = (s.x - s.r) * (s.x - s.r) - s.std_error * s.std_error - (squares - variance_of_references);
    spread += share(s) * share(s) * d2 * d2 / n;
  }
  // The reference's own noise adds to the differences; its variance is known and comes off.
  const double variance_of_field = std::max(squares - variance_of_references, 0.0);
  const double half_width = 1.96 * std::sqrt(spread / n);  // of the mean square
  error.rms_relative = std::sqrt(variance_of_field) / mean;
  error.confidence = (std::sqrt(variance_of_field + half_width) - std::sqrt(variance_of_field)) / mean;
  // Right when errors are distributed like the noise, and too large when few large errors make up the variance. A
  // distribution fitted to what lies behind the noise was tried: it took tails for noise and was low by a quarter.
  std::sort(relative.begin(), relative.end());
  double below = 0;
  const auto p95 = std::find_if(relative.begin(), relative.end() - 1,
                                [&](const auto& r) { return (below += r.second) > 0.95 * (n - 1); });
  error.p95_relative = p95->first * (squares > 0 ? std::sqrt(variance_of_field / squares) : 1.0);
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
///
/// problem  with other rays than those of the result.
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
      const Comparison& sample = samples[sample_of(k)];
      references.at.push_back({sample.x, luminous_mean(E), luminous_mean(std_error), sample.weight});
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

namespace {

/// Patches one after another, space after space, each as long as its chance to be looked at.
class PatchesBySpace {
 public:
  explicit PatchesBySpace(const PatchSet& patches) : order_(patches.patch_count()), cumulative_(patches.patch_count()) {
    std::iota(order_.begin(), order_.end(), 0u);
    const auto space_of = [&](std::uint32_t i) { return patches.space.empty() ? 0u : patches.space[i]; };
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t i, std::uint32_t j) { return space_of(i) < space_of(j); });
    double all = 0, roots = 0;
    std::map<std::uint32_t, double> area;
    for (const std::uint32_t i : order_) area[space_of(i)] += patches.area[i], all += patches.area[i];
    for (const auto& [space, a] : area) roots += std::sqrt(a);
    if (!(all > 0)) return;
    for (const auto& [space, a] : area) {
      // Half of the looks go by area, and half by its root, so that a small dark room beside a large hall gets some.
      const double looks = 0.5 * (a / all + std::sqrt(a) / roots);
      weight_[space] = a / all / looks;
    }
    for (std::size_t k = 0; k < order_.size(); ++k) {
      const double weight = weight_[space_of(order_[k])];
      cumulative_[k] = total_ += weight > 0 ? patches.area[order_[k]] / weight : 0;
      weight_of_.push_back(weight);
    }
  }

  double total() const { return total_; }
  struct Found {
    std::size_t patch;
    double weight;
  };
  Found at(double place) const {
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), place);
    const std::size_t k =
        std::min<std::size_t>(static_cast<std::size_t>(found - cumulative_.begin()), cumulative_.size() - 1);
    return {order_[k], weight_of_[k]};
  }

 private:
  std::vector<std::uint32_t> order_;
  std::vector<double> cumulative_, weight_of_;
  std::map<std::uint32_t, double> weight_;
  double total_ = 0;
};

}  // namespace

MeasuredError measure_error(const Problem& problem, const VertexLightmap& lightmap, const ErrorEffort& effort,
                            unsigned long long rays_spent, std::uint64_t seed, const Monitor& monitor) {
  const PatchSet& patches = problem.patches;
  const PatchesBySpace by_space(patches);
  if (!(by_space.total() > 0)) return {};
  const RayScene rays = problem.rays.with_nearer_ends();

  std::vector<Comparison> samples(kMostPoints);
  std::vector<ReceivingPoint> places(kMostPoints);
  RandomStream random(seed, kErrorPoints);
  for (std::size_t s = 0; s < kMostPoints; ++s) {
    const auto [i, weight_of_space] =
        by_space.at((static_cast<double>(s) + random.uniform()) / static_cast<double>(kMostPoints) * by_space.total());
    samples[s].weight = weight_of_space;
    const double u = random.uniform(), v = random.uniform();
    // The map is linear in the corners, so it interpolates their values as well as their positions.
    const auto weight = point_on_triangle({Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, u, v);
    for (int k = 0; k < 3; ++k)
      samples[s].x += weight[k] * luminous_mean(lightmap.E[lightmap.corners[i][static_cast<std::size_t>(k)]]);
    places[s] = {rays.off_surface(point_on_triangle(patches.corner_positions(PatchId{i}), u, v), patches.normal[i]),
                 patches.normal[i]};
  }
  return compare(
      {patches, rays, problem.lights}, samples, [&](std::size_t i) { return places[i]; }, effort, rays_spent,
      stream_key(seed, kErrorPaths), monitor);
}

MeasuredError measure_sensor_error(const Problem& problem, std::span<const SensorPoint> points, const Field& E,
                                   const ErrorEffort& effort, unsigned long long rays_spent, std::uint64_t seed,
                                   const Monitor& monitor) {
  const std::size_t count = std::min(points.size(), kMostPoints);
  if (count == 0) return {};
  const auto number_of = [&](std::size_t s) { return s * points.size() / count; };
  std::vector<Comparison> samples(count);
  for (std::size_t s = 0; s < count; ++s) samples[s].x = luminous_mean(E[number_of(s)]);
  const RayScene rays = problem.rays.with_nearer_ends();
  const PointOf point_of = sensor_points(points, problem.patches.origin, rays);
  return compare(
      {problem.patches, rays, problem.lights}, samples, [&](std::size_t s) { return point_of(number_of(s)); }, effort,
      rays_spent, stream_key(seed, kSensorErrorPaths), monitor);
}

}  // namespace clerestory
