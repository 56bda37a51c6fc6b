#include "solver/evaluate/reference_paths.h"

#include <algorithm>
#include <cmath>

#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr std::size_t kPoints = 16;
constexpr int kPaths = 32;         // of each kind, at each point
constexpr double kMuchBetter = 4;  // variance for the same rays; a pilot knows it to a factor of two
constexpr double kMissed = 0.3;    // of the light
constexpr double kNarrow = 1000;   // exponent of lobes that particles meet by chance only

/// Over the points.
struct Pilot {
  double E = 0, variance = 0;
  unsigned long long rays = 0;
};

Pilot pilot(const PathEstimator& estimator, std::size_t points, const PointOf& point_of, std::uint64_t key,
            const Monitor& monitor) {
  const std::size_t count = std::min(points, kPoints);
  std::vector<PathEstimate> found(count);
  std::vector<unsigned long long> rays(count, 0);
  parallel_for(count, 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      const auto [p, n] = point_of(k * points / count);
      found[k] = trace_paths_at_point(estimator, p, n, stream_key(key, k), kPaths, rays[k], monitor);
    }
  });
  Pilot all;
  for (std::size_t k = 0; k < count; ++k) {
    const double error = luminous_mean(found[k].std_error);
    all.E += luminous_mean(found[k].E), all.variance += error * error, all.rays += rays[k];
  }
  return all;
}

bool has_narrow_gloss(const Problem& problem) {
  if (problem.lights.luminaires.empty() && problem.lights.suns.empty()) return false;
  const auto& planes = problem.rays.gloss().planes();
  return std::ranges::any_of(planes, [](const GlossySides::Plane& plane) { return plane.sharpness > kNarrow; });
}

}  // namespace

ReferencePaths::ReferencePaths(const Illumination& light, std::size_t points, const PointOf& point_of,
                               std::uint64_t key, const Monitor& monitor)
    : estimator_(light) {
  if (points == 0 || has_narrow_gloss(light.problem) || !light.problem.lights.caustics.sides.empty()) return;
  both_.emplace(light);
  const Pilot one = pilot(estimator_, points, point_of, stream_key(key, kErrorPilots, 0), monitor),
              two = pilot(both_->estimator(), points, point_of, stream_key(key, kErrorPilots, 1), monitor);
  if (monitor.should_stop()) return;
  const auto cost = [](const Pilot& p) { return p.variance * static_cast<double>(p.rays); };
  const double missed = two.E - one.E;
  from_both_ends_ = cost(one) > kMuchBetter * cost(two) ||
                    (missed > kMissed * two.E && missed > 3 * std::sqrt(one.variance + two.variance));
  if (from_both_ends_) estimator_ = both_->estimator();
}

}  // namespace clerestory
