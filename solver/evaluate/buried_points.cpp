#include "solver/evaluate/buried_points.h"

#include <algorithm>
#include <limits>

#include "solver/gather/gather.h"
#include "solver/model/box.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

constexpr std::uint32_t kRays = 32, kRaysAround = 64;
constexpr double kTooNarrow = 0.5, kRoomy = 1.5;  ///< [m]

bool is_dark(const Hit& hit) { return !hit.escaped() && !hit.patch.valid(); }

bool sees_the_dark(const Problem& problem, const ReceivingPoint& at, std::uint64_t key) {
  const Frame frame(at.n);
  std::uint32_t dark = 0;
  for (std::uint32_t k = 0; k < kRays; ++k) {
    const auto u = sobol4(k, key);
    dark += is_dark(problem.rays.first_hit(problem.patches, {at.p, cosine_direction(frame, u[0], u[1])}));
  }
  return 2 * dark > kRays;
}

bool is_in_solid(const Problem& problem, const Vec3& p, std::uint64_t key) {
  const PatchSet& patches = problem.patches;
  std::uint32_t dark = 0, backs = 0, lit_beyond = 0;
  bool one_surface = true;
  SurfaceId surface;
  Vec3 lower = p, upper = p;
  for (std::uint32_t k = 0; k < kRaysAround; ++k) {
    const auto u = sobol4(k, key);
    const Ray ray{p, sphere_direction(u[0], u[1])};
    const Hit hit = problem.rays.first_hit(patches, ray);
    if (!is_dark(hit)) continue;
    ++dark;
    const auto& corner = patches.corners[hit.triangle];
    const Vec3 a = patches.vertices[corner[0]];
    const Vec3 n = cross(patches.vertices[corner[1]] - a, patches.vertices[corner[2]] - a);
    const bool joined = !patches.joined.empty() && patches.joined[hit.triangle];
    const Side side = dot(n, hit.direction(ray)) < 0 ? kFront : kBack;
    backs += side == kBack && !joined;
    lit_beyond += patches.side_patch[hit.triangle][side == kFront ? kBack : kFront].valid();
    const SurfaceId seen = patches.side_surface[hit.triangle][side];
    one_surface = one_surface && (!surface.valid() || seen.value == surface.value);
    surface = seen;
    const Vec3 q = hit.position(ray);
    lower = {std::min(lower.x, q.x), std::min(lower.y, q.y), std::min(lower.z, q.z)};
    upper = {std::max(upper.x, q.x), std::max(upper.y, q.y), std::max(upper.z, q.z)};
  }
  if (4 * dark < 3 * kRaysAround) return false;
  const Vec3 size = upper - lower;
  const double least = std::min({size.x, size.y, size.z});
  if (2 * backs > dark) return one_surface || least < kRoomy;
  return least < kTooNarrow || (least < kRoomy && 2 * lit_beyond > dark);
}

}  // namespace

std::vector<std::size_t> buried_points(const Problem& problem, std::span<const SensorPoint> points) {
  std::vector<char> is_buried(points.size(), 0);
  const PointOf point_of = sensor_points(points, problem.patches.origin, problem.rays);
  parallel_for(points.size(), 64, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      const ReceivingPoint at = point_of(i);
      const std::uint64_t key = stream_key(0, kBuriedPoints, i);
      is_buried[i] = sees_the_dark(problem, at, key) && is_in_solid(problem, at.p, key);
    }
  });
  std::vector<std::size_t> buried;
  for (std::size_t i = 0; i < is_buried.size(); ++i)
    if (is_buried[i]) buried.push_back(i);
  return buried;
}

}  // namespace clerestory
