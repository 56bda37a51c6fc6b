#include "solver/evaluate/measured_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>

#include "solver/evaluate/points_by_room.h"
#include "solver/evaluate/reference_paths.h"
#include "solver/evaluate/two_gathers.h"
#include "solver/gather/gather.h"
#include "solver/illumination/caustic_legs.h"
#include "solver/illumination/caustic_light.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/paths/path_tracer.h"
#include "solver/paths/without_caustics.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

constexpr int kFewestPaths = 64;          ///< a point, for a standard error that means something
constexpr int kFewestLongPaths = 16;      ///< of those that each see all of a room many times over
constexpr int kPilotPaths = 8;            ///< at each of the fewest points, to learn how long paths are
constexpr std::size_t kFewestPoints = 8;  ///< in rooms so bright that paths hardly end
constexpr std::size_t kMostPoints = 1 << 12;

constexpr std::size_t kPointsOfRoom = 24;  ///< at least, in the mean
constexpr double kShareOfRays = 0.03;      ///< of those that the result took

}  // namespace

bool MeasuredError::counts(const ErrorOfPart& part) const {
  double area = 0;
  for (const ErrorOfPart& p : parts) area += p.area;
  return part.area >= kLargeRoom * area;
}

const ErrorOfPart* MeasuredError::worst() const {
  const ErrorOfPart* worst = nullptr;
  for (const ErrorOfPart& part : parts)
    if (counts(part) && part.figures.samples > 0 && (!worst || part.figures.rms_relative > worst->figures.rms_relative))
      worst = &part;
  return worst;
}

MeasuredError::Largest MeasuredError::largest() const {
  if (!unknown().empty()) return {1, 1, 1};
  Largest found{lower(), rms_relative, upper()};
  for (const ErrorOfPart& part : parts) {
    if (!counts(part) || part.figures.samples == 0) continue;
    found.lower = std::max(found.lower, part.figures.lower());
    found.measured = std::max(found.measured, part.figures.rms_relative);
    found.upper = std::max(found.upper, part.figures.upper());
  }
  return found;
}

std::vector<const ErrorOfPart*> MeasuredError::unknown() const {
  std::vector<const ErrorOfPart*> found;
  for (const ErrorOfPart& part : parts)
    if (part.figures.samples == 0 && part.mean_illuminance > (counts(part) ? 0 : 1)) found.push_back(&part);
  return found;
}

namespace {

struct Compared {
  std::vector<Comparison> at;  ///< those that were finished
  std::string reference;
};

/// Figures of all comparisons, and of each part.
MeasuredError summarise_parts(const Compared& compared, std::vector<ErrorOfPart> parts) {
  const std::vector<Comparison>& comparisons = compared.at;
  MeasuredError error{summarise(comparisons), compared.reference};
  std::vector<std::vector<Comparison>> of_part(parts.size());
  for (const Comparison& c : comparisons) of_part[c.part].push_back(c);
  for (std::size_t k = 0; k < parts.size(); ++k) parts[k].figures = summarise(of_part[k]);
  error.parts = std::move(parts);
  return error;
}

struct References {
  std::vector<Comparison> at;       ///< those that were finished
  std::vector<std::size_t> sample;  ///< their numbers among the samples
  unsigned long long rays = 0;
  bool complete = false;
};

/// Caustics at the places of `at`, luminous means, by particles of their own over kernels of half the width of the
/// result's: what kernels blur is a quarter. parts: of the effort that the result took.
std::vector<double> other_caustics(const Problem& problem, std::size_t parts, const PointOf& point_of,
                                   std::size_t count, std::uint64_t key, const Monitor& monitor) {
  const Caustics& caustics = problem.lights.caustics;
  const auto legs = trace_caustics(problem, caustics.particles / parts, key, monitor);
  const CausticIrradiance found = caustic_irradiance(
      problem, legs, std::max<std::size_t>(1, caustics.legs_of_point / (4 * parts)), count, point_of);
  std::vector<double> E(count);
  for (std::size_t k = 0; k < count; ++k) E[k] = luminous_mean(found.E[k]);
  return E;
}

/// Adds them to the references, each by particles of its own; to those of paths in replicates, which tell their noise.
/// They have none without, so a deadline does not stop it: it makes them fewer.
void add_caustics(const Problem& problem, const PointOf& point_of, std::uint64_t key, const Monitor& monitor,
                  std::vector<Comparison>& at) {
  if (problem.lights.caustics.legs.empty()) return;
  const std::size_t parts = monitor.has_deadline() ? 8 : 4;
  Monitor patient;
  patient.interrupted = monitor.interrupted;
  const auto found = [&](std::size_t of, std::uint64_t set) {
    return other_caustics(problem, of, point_of, at.size(), stream_key(key, kErrorCaustics, set), patient);
  };
  std::vector<PathSum> of_paths(at.size());
  for (std::size_t r = 0; r < kReplicates; ++r) {
    const std::vector<double> E = found(parts * kReplicates, 2 + r);
    for (std::size_t k = 0; k < at.size(); ++k) of_paths[k].add(Spectrum(E[k]));
  }
  for (std::size_t k = 0; k < at.size(); ++k) {
    at[k].r += of_paths[k].mean()[0];
    at[k].std_error = std::hypot(at[k].std_error, of_paths[k].std_error()[0]);
  }
  if (at.empty() || at.front().gather < 0) return;
  const std::vector<double> one = found(parts, 0), two = found(parts, 1);
  for (std::size_t k = 0; k < at.size(); ++k) at[k].gather += one[k], at[k].other_gather += two[k];
}

/// Traces paths for references at the places of samples whose x is set, as many as the effort allows. Stopped by the
/// monitor, it takes those that are there.
///
/// problem  with other rays than those of the result.
Compared compare(const Problem& whole, const std::vector<Comparison>& samples, const PointOf& point_of,
                 const Solution& solution, const ErrorEffort& effort, std::uint64_t key, const Monitor& monitor) {
  const WithoutCaustics apart(whole);
  const Problem& problem = apart.problem();
  const Illumination light(problem);
  const ReferencePaths kind(light, samples.size(), point_of, key, monitor);
  std::string reference = kind.are_from_both_ends() ? "paths from both ends" : "paths";
  if (!whole.lights.caustics.legs.empty()) reference += " and particles";
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
            mean[t] =
                trace_replicate(kind.estimator(), p, n, stream_key(stream, i), t % kReplicates, paths, rays, monitor);
            finished[t] = !monitor.should_stop();
          }
          return rays;
        });
    References references{{}, {}, blocks.rays, blocks.done == mean.size()};
    for (std::size_t k = 0; k < count; ++k) {
      const auto first = static_cast<std::ptrdiff_t>(k * kReplicates);
      if (std::count(finished.begin() + first, finished.begin() + first + std::ptrdiff_t{kReplicates}, 0) > 0) continue;
      const auto [E, std_error] =
          estimate_of(std::span<const Spectrum, kReplicates>(&mean[k * kReplicates], kReplicates));
      references.sample.push_back(sample_of(k));
      references.at.push_back(samples[sample_of(k)]);
      references.at.back().r = luminous_mean(E);
      references.at.back().std_error = luminous_mean(std_error);
    }
    return references;
  };

  const std::size_t step = samples.size() / kFewestPoints + 1, pilots = (samples.size() + step - 1) / step;
  const References pilot = trace(pilots, key + 1, kPilotPaths, [&](std::size_t k) { return k * step; });
  const auto compared = [&](References references) -> Compared {
    add_caustics(
        whole, [&](std::size_t k) { return point_of(references.sample[k]); }, key, monitor, references.at);
    return {std::move(references.at), reference};
  };
  if (!pilot.complete) return compared(pilot);
  const double rays_per_path = static_cast<double>(pilot.rays) / static_cast<double>(pilots * kPilotPaths);
  const double affordable =  // paths in all
      std::max(kShareOfRays * static_cast<double>(solution.rays), effort.rays) / rays_per_path;
  const double points = static_cast<double>(std::min(samples.size(), effort.points));
  const int fewest = rays_per_path > kLongPath ? kFewestLongPaths : kFewestPaths;
  const int paths = std::clamp(static_cast<int>(affordable / points), fewest, effort.paths);
  const auto wanted =
      effort.asked_points.value_or(std::max(kFewestPoints, static_cast<std::size_t>(affordable / paths)));
  const auto count = std::min(samples.size(), wanted);
  const auto number_of = [&](std::size_t k) { return k * samples.size() / count; };
  References all = trace(count, key, paths, number_of);
  if (all.at.size() < pilot.at.size()) return compared(pilot);
  if (all.complete && solution.std_error.value.empty()) {
    const auto found = two_gathers(
        problem, solution, all.at.size(), [&](std::size_t k) { return point_of(number_of(k)); }, effort.gather, key,
        monitor);
    if (!found.empty()) reference += ", with gathers";
    for (std::size_t k = 0; k < found.size(); ++k) all.at[k].gather = found[k][0], all.at[k].other_gather = found[k][1];
  }
  return compared(std::move(all));
}

/// Rooms with their area and what the result says of their light.
std::vector<ErrorOfPart> parts_of(const PointsByRoom& by_room, const PatchSet& patches, const Field& E) {
  std::vector<ErrorOfPart> parts(by_room.areas().size());
  for (std::size_t k = 0; k < patches.rooms.size(); ++k) parts[k].name = patches.rooms[k];
  if (patches.rooms.empty()) parts[0].name = "all surfaces";
  for (std::size_t k = 0; k < parts.size(); ++k) parts[k].area = by_room.areas()[k];
  for (std::size_t i = 0; i < patches.patch_count(); ++i)
    parts[patches.room_of(i)].mean_illuminance += photometric(E[i]) * patches.area[i];
  for (ErrorOfPart& p : parts)
    if (p.area > 0) p.mean_illuminance /= p.area;
  return parts;
}

/// How much of the field changes within each patch, and between it and the patch's own irradiance: a spot that all
/// vertices miss.
std::vector<double> change_within(const VertexLightmap& lightmap, const Field& E) {
  std::vector<double> change(lightmap.corners.size());
  for (std::size_t i = 0; i < change.size(); ++i) {
    double low = std::numeric_limits<double>::infinity(), high = 0, mean = 0;
    for (const std::uint32_t p : lightmap.corners[i]) {
      const double x = luminous_mean(lightmap.E[p]);
      low = std::min(low, x), high = std::max(high, x), mean += x / 3;
    }
    change[i] = std::max(high - low, std::abs(luminous_mean(E[i]) - mean));
  }
  return change;
}

}  // namespace

MeasuredError measure_error(const Problem& problem, const VertexLightmap& lightmap, const Solution& solution,
                            const ErrorEffort& effort, std::uint64_t seed, const Monitor& monitor) {
  const PatchSet& patches = problem.patches;
  const PointsByRoom by_room(patches, change_within(lightmap, solution.E));
  if (!(by_room.total() > 0)) return {};
  const RayScene rays = problem.rays.with_nearer_ends();

  const std::vector<PointInRoom> points = by_room.points(kMostPoints, stream_key(seed, kErrorPoints));
  std::vector<Comparison> samples(kMostPoints);
  std::vector<ReceivingPoint> places(kMostPoints);
  for (std::size_t s = 0; s < kMostPoints; ++s) {
    const auto& [i, room, weight_of_room, u, v] = points[s];
    samples[s].part = room;
    samples[s].weight = weight_of_room;
    samples[s].albedo = luminous_mean(patches.albedo(i));
    // The map is linear in the corners, so it interpolates their values as well as their positions.
    const auto weight = point_on_triangle({Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, u, v);
    double mean = 0;
    for (int k = 0; k < 3; ++k) {
      const double at_corner = luminous_mean(lightmap.E[lightmap.corners[i][static_cast<std::size_t>(k)]]);
      samples[s].x += weight[k] * at_corner, mean += at_corner / 3;
    }
    samples[s].element = luminous_mean(solution.E[i]);
    samples[s].off_mean = samples[s].x - mean;
    places[s] = {rays.off_surface(point_on_triangle(patches.corner_positions(PatchId{i}), u, v), patches.normal[i]),
                 patches.normal[i]};
  }
  ErrorEffort spend = effort;
  spend.points = std::min(kMostPoints, std::max(effort.points, kPointsOfRoom * by_room.large_rooms()));
  return summarise_parts(compare(
                             {patches, rays, problem.lights}, samples, [&](std::size_t i) { return places[i]; },
                             solution, spend, stream_key(seed, kErrorPaths), monitor),
                         parts_of(by_room, patches, solution.E));
}

MeasuredError measure_sensor_error(const Problem& problem, std::span<const SensorPoint> points,
                                   std::span<const PointsOfSet> sets, const Field& E, const Solution& solution,
                                   const ErrorEffort& effort, std::uint64_t seed, const Monitor& monitor) {
  const std::size_t count = std::min(points.size(), kMostPoints);
  if (count == 0) return {};
  const auto number_of = [&](std::size_t s) { return s * points.size() / count; };
  std::vector<Comparison> samples(count);
  std::vector<ErrorOfPart> parts;
  for (std::size_t k = 0, i = 0; k < sets.size(); ++k) {
    parts.push_back({.name = sets[k].name, .figures = {}});
    const double points_of_set = static_cast<double>(sets[k].end - i);
    for (; i < sets[k].end; ++i) parts.back().mean_illuminance += photometric(E[i]) / points_of_set;
  }
  for (std::size_t s = 0; s < count; ++s) {
    samples[s].x = luminous_mean(E[number_of(s)]);
    samples[s].part =
        static_cast<std::uint32_t>(std::ranges::upper_bound(sets, number_of(s), {}, &PointsOfSet::end) - sets.begin());
  }
  const RayScene rays = problem.rays.with_nearer_ends();
  const PointOf point_of = sensor_points(points, problem.patches.origin, rays);
  return summarise_parts(
      compare(
          {problem.patches, rays, problem.lights}, samples, [&](std::size_t s) { return point_of(number_of(s)); },
          solution, effort, stream_key(seed, kSensorErrorPaths), monitor),
      std::move(parts));
}

}  // namespace clerestory
