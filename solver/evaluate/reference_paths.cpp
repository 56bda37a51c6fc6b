#include "solver/evaluate/reference_paths.h"

#include <algorithm>
#include <cmath>

#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr std::size_t kPoints = 16, kFirstPoints = 2;
constexpr int kPaths = 32, kFirstPaths = 8;  // of each kind, at each point
constexpr double kMuchBetter = 4;            // variance for the same rays; a pilot knows it to a factor of two
constexpr double kMissed = 0.2;              // of the light, in the mean of the points
constexpr double kSure = 3;                  // standard errors of that
constexpr double kNarrow = 1000;             // exponent of lobes that particles meet by chance only

struct Pilot {
  std::vector<double> E, variance;  ///< by point, luminous means
  unsigned long long rays = 0;
};

/// At `most` of the points.
Pilot pilot(const PathEstimator& estimator, std::size_t points, const PointOf& point_of, std::size_t most, int paths,
            std::uint64_t key, const Monitor& monitor) {
  const std::size_t count = std::min(points, most);
  Pilot found{std::vector<double>(count), std::vector<double>(count)};
  std::vector<unsigned long long> rays(count, 0);
  parallel_for(count, 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      const auto [p, n] = point_of(k * points / count);
      const auto [E, std_error] = trace_paths_at_point(estimator, p, n, stream_key(key, k), paths, rays[k], monitor);
      found.E[k] = luminous_mean(E), found.variance[k] = luminous_mean(std_error) * luminous_mean(std_error);
    }
  });
  for (const auto r : rays) found.rays += r;
  return found;
}

/// Sums over the points, each relative to its own light: dark rooms count as bright ones do.
struct PilotsCompared {
  double one = 0, two = 0;  ///< variance times rays
  double missed = 0, variance = 0, points = 0;

  PilotsCompared(const Pilot& a, const Pilot& b) {
    for (std::size_t k = 0; k < a.E.size(); ++k) {
      const double E = std::max(a.E[k], b.E[k]);
      if (!(E > 0)) continue;
      one += a.variance[k] / (E * E) * static_cast<double>(a.rays);
      two += b.variance[k] / (E * E) * static_cast<double>(b.rays);
      missed += (b.E[k] - a.E[k]) / E;
      variance += (a.variance[k] + b.variance[k]) / (E * E);
      ++points;
    }
  }
};

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
  const auto at = [&](const PathEstimator& estimator, std::size_t most, int paths, std::uint64_t set) {
    return pilot(estimator, points, point_of, most, paths, stream_key(key, kErrorPilots, set), monitor);
  };
  const double first = static_cast<double>(at(estimator_, kFirstPoints, kFirstPaths, 2).rays);
  if (first > kLongPath * kFirstPaths * static_cast<double>(std::min(points, kFirstPoints))) return;
  both_.emplace(light);
  const Pilot one = at(estimator_, kPoints, kPaths, 0), two = at(both_->estimator(), kPoints, kPaths, 1);
  if (monitor.should_stop()) return;
  const PilotsCompared compared(one, two);
  if (compared.missed < -kSure * std::sqrt(compared.variance)) return;
  from_both_ends_ = compared.one > kMuchBetter * compared.two ||
                    compared.missed > std::max(kMissed * compared.points, kSure * std::sqrt(compared.variance));
  if (from_both_ends_) estimator_ = both_->estimator();
}

}  // namespace clerestory
