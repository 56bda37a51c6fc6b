#include "pipeline/tradeoff/path_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pipeline/require_valid.h"
#include "pipeline/scene_checks.h"
#include "solver/evaluate/points_by_room.h"
#include "solver/illumination/illumination.h"
#include "solver/model/error.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/paths/path_tracer.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

constexpr std::size_t kPoints = 400, kPointsOfRoom = 64, kMostPoints = 2048;

/// Patches of their own, with nothing simplified.
PreparedToSolve prepare_reference(const Scene& scene, std::uint64_t seed, Observer& observer) {
  Settings settings;
  settings.solve.seed = seed;
  settings.solve.accuracy = Accuracy::fine;
  settings.detail = 0;
  require_valid(scene, settings);
  warn_about_scene(scene, observer);
  require_light(scene);
  StageSeconds seconds;
  // Nobody interrupts it: the program's own handler ends it while there is no result.
  const Monitor monitor{.progress = [&](std::string_view stage, double done) { observer.progress(stage, done); },
                        .interrupted = {}};
  return *prepare_to_solve(scene, settings, observer, monitor, seconds);
}

}  // namespace

PathReference::PathReference(const Scene& scene, std::uint64_t seed, Observer& observer)
    : seed_(seed), prepared_(prepare_reference(scene, seed, observer)), rays_(prepared_.scene.rays.with_nearer_ends()) {
  const PatchSet& patches = prepared_.scene.patches;
  const PointsByRoom by_room(patches);
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

bool PathReference::add_paths(int paths, const Monitor& monitor) {
  const Problem problem{prepared_.scene.patches, rays_, prepared_.scene.lights};
  const Illumination light(problem);
  const Vec3 origin = prepared_.scene.patches.origin;
  const auto point_of = [&](std::size_t i) {
    return ReceivingPoint{rays_.off_surface(points_[i].p - origin, points_[i].n), points_[i].n};
  };
  const PointIrradiance at = trace_paths_at(light, points_.size(), point_of, paths,
                                            stream_key(seed_, kReferencePaths, rounds_), "reference", monitor);
  if (!at.complete()) return false;
  ++rounds_;
  const double before = static_cast<double>(paths_), now = paths, all = before + now;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    ReferencePoint& to = points_[i];
    to.E = (before * to.E + now * photometric(at.E[i])) / all;
    to.std_error = std::hypot(before * to.std_error, now * photometric(at.std_error[i])) / all;
  }
  paths_ += paths;
  return true;
}

double PathReference::std_error_of(std::uint32_t room) const {
  double weights = 0, level = 0, squares = 0;
  for (const ReferencePoint& at : points_) {
    if (at.room != room) continue;
    weights += at.weight, level += at.weight * at.E, squares += at.weight * at.std_error * at.std_error;
  }
  return level > 0 ? std::sqrt(squares * weights) / level : std::numeric_limits<double>::infinity();
}

}  // namespace clerestory
