#include "solver/lit_sides.h"

#include <algorithm>
#include <array>

#include "solver/lights/light_sampler.h"
#include "solver/lights/point_lights.h"
#include "solver/lights/sun.h"
#include "solver/model/disjoint_sets.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/sampling.h"

namespace clerestory {
namespace {

enum StreamKind : std::uint64_t { kSideRays = 0x31, kLampRays = 0x32, kLampSearch = 0x33 };

/// Patches seen by rays of patch i.
struct Seen {
  std::vector<PatchId> patches;  ///< one entry a ray that met one
  bool outside = false;          ///< a ray left the scene
  bool sun = false;
};

Seen look_around(const Problem& problem, std::size_t i, int ray_count, std::uint64_t seed) {
  const PatchSet& patches = problem.patches;
  const Frame frame(patches.normal[i]);
  auto corners = patches.corner_positions(PatchId{i});
  // Off the edges: a start that rounding puts behind the neighbour would join the inside of a solid to the room.
  const Vec3 centre = (corners[0] + corners[1] + corners[2]) / 3;
  for (Vec3& corner : corners) corner = centre + (corner - centre) * 0.98;
  const double lift = problem.rays.lift();
  const std::uint64_t key = stream_key(seed, kSideRays, i);
  Seen seen;
  for (int k = 0; k < ray_count; ++k) {
    const auto u = sobol4(static_cast<std::uint32_t>(k), key);
    const Hit hit = problem.rays.first_hit(
        patches, {point_on_triangle(corners, u[2], u[3]) + frame.n * lift, cosine_direction(frame, u[0], u[1])});
    seen.outside = seen.outside || hit.escaped();
    if (hit.patch.valid()) seen.patches.push_back(hit.patch);
  }
  for (const Sun& sun : problem.lights.suns) {
    for (int k = 0; k < 16 && !seen.sun; ++k) {
      const auto u = sobol4(static_cast<std::uint32_t>(k), key + 1);
      const Vec3 d = direction_to_sun(sun, u[2], u[3]);
      if (dot(d, frame.n) <= 0) continue;
      seen.sun =
          problem.rays.first_hit(patches, {point_on_triangle(corners, u[0], u[1]) + frame.n * lift, d}).escaped();
    }
  }
  return seen;
}

/// Whether one of the lamps or glowing patches lights patch i without a bounce: for what sees nothing but them.
struct Found {
  bool lit = false;              ///< by a luminaire
  std::vector<PatchId> glowing;  ///< patches that light it
};

Found look_for_lamps(const Problem& problem, const LightSampler& emitters, std::size_t i, std::uint64_t seed) {
  const auto corners = problem.patches.corner_positions(PatchId{i});
  const Vec3 n = problem.patches.normal[i];
  const double lift = problem.rays.lift();
  const std::uint64_t key = stream_key(seed, kLampSearch, i);
  std::array<Vec3, 64> points;
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    const auto u = sobol4(k, key);
    points[k] = point_on_triangle(corners, u[0], u[1]) + n * lift;
  }
  Found found;
  const auto look_at = [&](const auto& lamp) {
    SegmentPacket segments;
    unsigned facing = 0;
    for (int lane = 0; lane < 16; ++lane) {
      const Vec3& p = points[static_cast<std::size_t>(lane)];
      segments.set(lane, p, lamp.position);
      if (!open_irradiance(lamp, p, n).is_black()) facing |= 1u << lane;
    }
    if (facing && problem.rays.visible16(segments, static_cast<std::uint16_t>(facing))) found.lit = true;
  };
  for (const auto& lamp : problem.lights.points) look_at(lamp);
  for (const auto& lamp : problem.lights.spots) look_at(lamp);
  for (std::uint32_t k = 0; k < points.size() && emitters.has_emitters(); ++k) {
    const auto u = sobol4(k, key);
    const LightSample s = emitters.sample(points[k], n, (k + u[2]) / points.size(), u[3], u[0], true);
    if (s.patch.valid() && !problem.rays.transmittance(points[k], s.end).is_black()) found.glowing.push_back(s.patch);
  }
  return found;
}

template <class Lamp>
void mark_lit_by(const Problem& problem, const Lamp& lamp, std::size_t number, std::uint64_t seed,
                 std::vector<bool>& lit) {
  for (std::uint32_t k = 0; k < 4096; ++k) {
    const auto u = sobol4(k, stream_key(seed, kLampRays, number));
    const Hit hit = problem.rays.first_hit(problem.patches, {lamp.position, sphere_direction(u[0], u[1])});
    if (hit.patch.valid()) lit[hit.patch] = true;
  }
}

}  // namespace

LitSides find_lit_sides(const Problem& problem, std::uint64_t seed, const Monitor& monitor) {
  const PatchSet& patches = problem.patches;
  const std::size_t n = patches.patch_count();
  // Enough rays in all that a space of few large patches is not taken apart by chance.
  const int ray_count = 16 * static_cast<int>(std::clamp<std::size_t>((1 << 15) / std::max<std::size_t>(n, 1), 1, 16));

  DisjointSets spaces(n);
  std::vector<bool> lit(n, false);
  std::vector<char> sees_a_surface(n, 0);
  constexpr std::size_t kBlock = 1 << 14;
  for (std::size_t begin = 0; begin < n; begin += kBlock) {
    if (monitor.should_stop()) {  // what was not looked at takes part
      for (std::size_t i = begin; i < n; ++i) lit[i] = true;
      break;
    }
    std::vector<Seen> seen(std::min(kBlock, n - begin));
    parallel_for(seen.size(), 32, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) seen[i] = look_around(problem, begin + i, ray_count, seed);
    });
    for (std::size_t i = 0; i < seen.size(); ++i) {
      for (const PatchId q : seen[i].patches) {
        spaces.join(begin + i, q);
        sees_a_surface[begin + i] = sees_a_surface[q] = 1;
      }
      if (seen[i].sun || (seen[i].outside && problem.lights.sky)) lit[begin + i] = true;
    }
  }
  std::size_t number = 0;
  for (const auto& lamp : problem.lights.points) mark_lit_by(problem, lamp, number++, seed, lit);
  for (const auto& lamp : problem.lights.spots) mark_lit_by(problem, lamp, number++, seed, lit);

  // In the open a patch may see nothing but lamps, which rays seldom meet.
  std::vector<char> space_lit(n, 0);
  for (std::size_t i = 0; i < n; ++i)
    if (lit[i]) space_lit[spaces.find(i)] = 1;
  std::vector<std::uint32_t> doubtful;
  for (std::size_t i = 0; i < n; ++i)
    if (!space_lit[spaces.find(i)]) doubtful.push_back(static_cast<std::uint32_t>(i));
  const LightSampler emitters(problem, patches.M);
  std::vector<Found> found(doubtful.size());
  parallel_for(doubtful.size(), 32, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to && !monitor.should_stop(); ++k)
      found[k] = look_for_lamps(problem, emitters, doubtful[k], seed);
  });
  for (std::size_t k = 0; k < doubtful.size(); ++k) {
    if (found[k].lit) lit[doubtful[k]] = true;
    for (const PatchId q : found[k].glowing) {
      spaces.join(doubtful[k], q);
      sees_a_surface[doubtful[k]] = sees_a_surface[q] = 1;
    }
  }

  struct Space {
    bool lit = false, glows = false, visited = false;
    MaterialId only_material;  ///< invalid when there are several
  };
  std::vector<Space> space(n);
  for (std::size_t i = 0; i < n; ++i) {
    Space& s = space[spaces.find(i)];
    const MaterialId material = patches.material(PatchId{i});
    s.lit = s.lit || lit[i];
    s.glows = s.glows || (sees_a_surface[i] && !patches.M[i].is_black());
    s.only_material = !s.visited || s.only_material.value == material.value ? material : MaterialId{};
    s.visited = true;
  }
  std::vector<char> lights_others(patches.materials.size(), 0);
  for (std::size_t i = 0; i < n; ++i)
    if (!patches.M[i].is_black() && !space[spaces.find(i)].only_material.valid())
      lights_others[patches.material(PatchId{i})] = 1;

  LitSides result;
  result.wanted.assign(2 * patches.triangle_count(), false);
  for (std::size_t i = 0; i < n; ++i) {
    const Space& s = space[spaces.find(i)];
    const bool inside_lamp = !s.lit && s.glows && s.only_material.valid() && lights_others[s.only_material];
    if (s.lit || (s.glows && !inside_lamp))
      result.wanted[2 * patches.triangle[i] + patches.side[i]] = true;
    else
      ++(inside_lamp ? result.lamp_interiors : result.dark_sides);
  }
  return result;
}

}  // namespace clerestory
