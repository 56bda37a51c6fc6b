#include "pipeline/tradeoff/sweep_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pipeline/require_valid.h"
#include "pipeline/scene_checks.h"
#include "solver/evaluate/points_by_room.h"
#include "solver/evaluate/two_gathers.h"
#include "solver/illumination/caustic_light.h"
#include "solver/illumination/illumination.h"
#include "solver/model/error.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/paths/path_tracer.h"
#include "solver/paths/without_caustics.h"
#include "solver/run/accuracy.h"
#include "solver/run/solve.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

constexpr std::size_t kPoints = 400, kPointsOfRoom = 64, kMostPoints = 2048;

double squared(double x) { return x * x; }

/// Patches of their own, with nothing simplified.
PreparedToSolve prepare_reference(const Scene& scene, std::uint64_t seed, Observer& observer,
                                  std::chrono::steady_clock::time_point end) {
  Settings settings;
  settings.solve.seed = seed;
  settings.solve.accuracy = Accuracy::fine;
  settings.detail = 0;
  require_valid(scene, settings);
  warn_about_scene(scene, observer);
  require_light(scene);
  StageSeconds seconds;
  // Nobody else interrupts it: the program's own handler ends it while there is no result.
  const auto is_late = [end] { return std::chrono::steady_clock::now() >= end; };
  const Monitor monitor{.progress = [&](std::string_view stage, double done) { observer.progress(stage, done); },
                        .interrupted = is_late};
  std::optional<PreparedToSolve> prepared = prepare_to_solve(scene, settings, observer, monitor, seconds);
  if (!prepared || is_late()) throw SweepReference::OutOfTime();
  return std::move(*prepared);
}

/// How much light straight from sun and luminaires changes within each patch, between its corners and its middle; empty
/// where that would take long.
std::vector<double> change_of_delta_light(const Problem& problem, std::uint64_t seed) {
  constexpr std::size_t kMostPairs = 2'000'000;
  const PatchSet& patches = problem.patches;
  const std::size_t lights = problem.lights.luminaires.size() + problem.lights.suns.size();
  if (lights == 0 || patches.patch_count() * lights > kMostPairs) return {};
  const Illumination light(problem);
  std::vector<double> change(patches.patch_count());
  parallel_for(change.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto x = patches.corner_positions(PatchId{i});
      const Vec3 n = patches.normal[i], middle = (x[0] + x[1] + x[2]) / 3;
      double low = std::numeric_limits<double>::infinity(), high = 0;
      for (const Vec3& corner : {x[0], x[1], x[2], middle}) {
        const Vec3 p = problem.rays.off_surface(middle + (corner - middle) * 0.98, n);
        const double E = luminous_mean(light.sampler.delta_light(p, n, {.sun_rays = 1}, seed));
        low = std::min(low, E), high = std::max(high, E);
      }
      change[i] = high - low;
    }
  });
  return change;
}

}  // namespace

SweepReference::SweepReference(const Scene& scene, std::uint64_t seed, Observer& observer,
                               std::chrono::steady_clock::time_point end)
    : seed_(seed), prepared_(prepare_reference(scene, seed, observer, end)) {
  const PatchSet& patches = prepared_.scene.patches;
  const PointsByRoom by_room(patches, change_of_delta_light(prepared_.scene.problem(), seed));
  if (!(by_room.total() > 0)) throw InputError(scene.file + ": no surface that light can reach has an area.");
  for (std::size_t k = 0; k < by_room.areas().size(); ++k)
    rooms_.push_back({patches.rooms.empty() ? "all surfaces" : patches.rooms[k], by_room.areas()[k],
                      by_room.areas()[k] >= kLargeRoom * patches.total_area()});
  const std::size_t count = std::clamp(kPointsOfRoom * by_room.large_rooms(), kPoints, kMostPoints);
  for (const PointInRoom& at : by_room.points(count, stream_key(seed, kReferencePoints)))
    points_.push_back({point_on_triangle(patches.corner_positions(PatchId{at.patch}), at.u, at.v) + patches.origin,
                       patches.normal[at.patch], at.room, at.weight});
  const MeshReport& repairs = prepared_.scene.repairs;
  tolerance_ = repairs.simplified_by + repairs.tolerance;
  diagonal_ = length(repairs.upper - repairs.lower);
}

ReceivingPoint SweepReference::place(std::size_t i) const {
  const ReferencePoint& at = points_[i];
  return {prepared_.scene.rays.off_surface(at.p - prepared_.scene.patches.origin, at.n), at.n};
}

bool SweepReference::add_paths(int paths, const Monitor& monitor) {
  const Problem problem = prepared_.scene.problem();
  if (rounds_ == 0) caustics_ = caustic_irradiance(problem, points_.size(), [&](std::size_t i) { return place(i); }).E;
  const WithoutCaustics apart(problem);
  const Illumination light(apart.problem());
  const PointIrradiance at = trace_paths_at(
      light, points_.size(), [&](std::size_t i) { return place(i); }, paths,
      stream_key(seed_, kReferencePaths, ++rounds_), "reference", monitor);
  if (!at.complete()) return false;
  const double before = static_cast<double>(paths_), now = paths, all = before + now;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    ReferencePoint& to = points_[i];
    to.E = (before * to.E + now * photometric(at.E[i] + caustics_[i])) / all;
    to.std_error = std::hypot(before * to.std_error, now * photometric(at.std_error[i])) / all;
  }
  paths_ += paths;
  return true;
}

bool SweepReference::add_gathers(Accuracy accuracy, const Monitor& monitor) {
  Prepared& scene = prepared_.scene;
  const SolveOptions options{.accuracy = accuracy, .seed = stream_key(seed_, kReferencePaths)};
  SolvedPatches solved =
      solve(scene.problem(), std::move(prepared_.lightmap), scene.repairs.max_element, options, monitor);
  if (monitor.should_stop() || solved.solution.stop != StopReason::converged) return false;
  if (solved.elements.patch_count() > 0) scene.patches = std::move(solved.elements);
  const Problem problem = scene.problem();
  const auto found = two_gathers(
      problem, solved.solution, points_.size(), [&](std::size_t i) { return place(i); }, effort(Accuracy::fine).sensors,
      stream_key(seed_, kReferencePaths), monitor);
  for (std::size_t i = 0; i < found.size(); ++i) {
    points_[i].gather = kWhiteEfficacy * found[i][0];
    points_[i].other_gather = kWhiteEfficacy * found[i][1];
  }
  return !found.empty();
}

double SweepReference::std_error_of(std::uint32_t room) const {
  double weights = 0, level = 0, paths = 0, gathers = 0, of_mean = 0;
  for (const ReferencePoint& at : points_) {
    if (at.room != room) continue;
    weights += at.weight, level += at.weight * at.E;
    paths += at.weight * squared(at.std_error), of_mean += squared(at.weight * at.std_error);
    gathers += at.weight * squared((at.gather - at.other_gather) / 2);
  }
  if (!(level > 0)) return std::numeric_limits<double>::infinity();
  return std::sqrt(has_gathers() ? gathers * weights + of_mean : paths * weights) / level;
}

}  // namespace clerestory
