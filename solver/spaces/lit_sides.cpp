#include "solver/spaces/lit_sides.h"

#include <algorithm>
#include <array>

#include "solver/illumination/bright_areas.h"
#include "solver/illumination/light_sampler.h"
#include "solver/lights/beam.h"
#include "solver/lights/luminaire.h"
#include "solver/lights/near_planes.h"
#include "solver/lights/sun.h"
#include "solver/model/disjoint_sets.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/openings/openings.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/echoes.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

constexpr std::size_t kBlock = 1 << 14;  ///< patches between two looks at what is known by then
/// Points from which a patch looks for luminaires, and shadow rays to bright patches.
constexpr std::size_t kLuminaireSamples = 64;

/// Patches that see each other, and what is known of each such space.
class Spaces {
 public:
  explicit Spaces(const PatchSet& patches) : sets_(patches.patch_count()), of_(patches.patch_count()) {
    for (std::size_t i = 0; i < of_.size(); ++i) of_[i].only_material = patches.material(PatchId{i});
  }
  void see_each_other(const PatchSet& patches, std::size_t p, std::size_t q) {
    Space& a = of_[sets_.find(p)];
    a.glows |= !patches.M[p].is_black() || !patches.M[q].is_black();
    Space& b = of_[sets_.find(q)];
    sets_.join(p, q);
    Space& joined = of_[sets_.find(p)];
    const bool one_material = a.only_material.value == b.only_material.value;
    joined = {a.lit || b.lit, a.glows || b.glows, one_material ? a.only_material : MaterialId{}};
  }
  void light(std::size_t i) { of_[sets_.find(i)].lit = true; }
  /// What sees the sky, or nothing but lights: the open air is one space.
  void light_outdoors(const PatchSet& patches, std::size_t i) {
    if (outdoors_.valid()) see_each_other(patches, outdoors_, i);
    outdoors_ = PatchId{i};
    light(i);
  }
  /// All that one light shines on.
  void light(const PatchSet& patches, std::span<const PatchId> met) {
    PatchId first;
    for (const PatchId p : met) {
      if (!p.valid()) continue;
      if (first.valid()) see_each_other(patches, first, p);
      first = p;
      light(p);
    }
  }

  bool is_lit(std::size_t i) const { return of_[sets_.name(i)].lit; }
  bool glows(std::size_t i) const { return of_[sets_.name(i)].glows; }
  std::uint32_t name(std::size_t i) const { return static_cast<std::uint32_t>(sets_.name(i)); }
  /// Invalid when there are several.
  MaterialId only_material(std::size_t i) const { return of_[sets_.name(i)].only_material; }
  /// Takes part, whatever else may be found: nothing that sees it needs to look around for itself.
  bool is_settled(std::size_t i) const {
    const Space& s = of_[sets_.name(i)];
    return s.lit || (s.glows && !s.only_material.valid());
  }

 private:
  struct Space {
    bool lit = false, glows = false;
    MaterialId only_material;
  };
  DisjointSets sets_;
  std::vector<Space> of_;
  PatchId outdoors_;  ///< one of there
};

/// Patches seen by rays of patch i.
struct Seen {
  std::vector<PatchId> patches;  ///< one entry a ray that met one
  bool outside = false;          ///< a ray left the scene
  bool sun = false;
};

/// Ends with the first sight of a space that takes part: then so does patch i.
Seen look_around(const Problem& problem, const Spaces& spaces, std::size_t i, int ray_count, std::uint64_t seed) {
  const PatchSet& patches = problem.patches;
  const Frame frame(patches.normal[i]);
  auto corners = patches.corner_positions(PatchId{i});
  // Off the edges: a start that rounding puts behind the neighbour would join the inside of a solid to the room.
  const Vec3 centre = (corners[0] + corners[1] + corners[2]) / 3;
  for (Vec3& corner : corners) corner = centre + (corner - centre) * 0.98;
  const auto lifted = [&](double u, double v) {
    return problem.rays.off_surface(point_on_triangle(corners, u, v), frame.n);
  };
  const std::uint64_t key = stream_key(seed, kSideRays, i);
  Seen seen;
  for (int k = 0; k < ray_count; ++k) {
    const auto u = sobol4(static_cast<std::uint32_t>(k), key);
    Echo echo;
    const Hit hit = problem.rays.first_hit(patches, {lifted(u[2], u[3]), cosine_direction(frame, u[0], u[1])}, &echo);
    bool settled = false;
    const auto take = [&](const Hit& h) {
      seen.outside = seen.outside || h.escaped();
      if (!h.patch.valid()) return;
      seen.patches.push_back(h.patch);
      settled = settled || spaces.is_settled(h.patch);
    };
    take(hit);
    if (!settled) follow_echo(problem.rays, patches, echo, key, static_cast<std::uint64_t>(k), take);
    if (settled) return seen;
  }
  for (const PlacedSun& sun : problem.lights.suns) {
    if (sun.is_image()) continue;  // the space is told by rays that mirrors turn
    for (int k = 0; k < 16 && !seen.sun; ++k) {
      const auto u = sobol4(static_cast<std::uint32_t>(k), key + 1);
      const Vec3 d = direction_to_sun(sun, u[2], u[3]);
      if (dot(d, frame.n) <= 0) continue;
      seen.sun = problem.rays.first_hit(patches, {lifted(u[0], u[1]), d}).escaped();
    }
  }
  return seen;
}

/// Whether one of the luminaires or glowing patches lights patch i without a bounce: for what sees nothing but them.
struct Found {
  bool lit = false;              ///< by a luminaire
  std::vector<PatchId> glowing;  ///< patches that light it
};

/// Every `stride`-th of the luminaires is looked for, another set for each patch.
Found look_for_lights(const Problem& problem, const LightSampler& emitters, std::size_t i, std::size_t stride,
                      std::size_t samples, std::uint64_t seed) {
  const auto corners = problem.patches.corner_positions(PatchId{i});
  const Vec3 n = problem.patches.normal[i];
  const std::uint64_t key = stream_key(seed, kLuminaireSearch, i);
  std::array<Vec3, kLuminaireSamples> points;
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    const auto u = sobol4(k, key);
    points[k] = problem.rays.off_surface(point_on_triangle(corners, u[0], u[1]), n);
  }
  Found found;
  const std::vector<PlacedLuminaire>& luminaires = problem.lights.luminaires;
  for (std::size_t number = i % stride; number < luminaires.size() && !found.lit; number += stride) {
    const PlacedLuminaire& luminaire = luminaires[number];
    if (luminaire.is_image()) continue;
    found.lit = any_visible(problem.rays, 16, [&](std::uint32_t k, Vec3& from, Vec3& to) {
      const auto u = sobol4(k, key + 1);
      const Vec3 q = light_point(luminaire, points[k], u[0], u[1]);
      const ShadowSegment way = shadow_segment(luminaire, q, points[k]);
      from = way.from, to = way.to;
      return !open_irradiance(luminaire, q, points[k], n).is_black();
    });
  }
  for (std::uint32_t k = 0; k < samples && emitters.has_bright_patches(); ++k) {
    const auto u = sobol4(k, key);
    const LightSample s =
        emitters.sample(emitters.receiver(points[k], n), (k + u[2]) / static_cast<double>(samples), u[3], u[0], true);
    if (s.patch.valid() && !problem.rays.transmittance(points[k], s.end).is_black()) found.glowing.push_back(s.patch);
  }
  return found;
}

/// Sides that rays of the luminaires meet. Many luminaires share the rays of sixteen: they stand in the same rooms.
void light_by_luminaires(const Problem& problem, std::uint64_t seed, Spaces& spaces) {
  const std::vector<PlacedLuminaire>& luminaires = problem.lights.luminaires;
  const std::size_t count = luminaires.size();
  if (count == 0) return;
  // Of very many each stands among others, and the sides look around as well: the effort has a bound.
  const std::size_t rays_each =
      std::min(std::clamp<std::size_t>((1 << 16) / count, 256, 4096), std::max<std::size_t>((1 << 22) / count, 8));
  std::vector<PatchId> met(count * rays_each);
  parallel_for(count, 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t number = from; number < to; ++number) {
      const PlacedLuminaire& luminaire = luminaires[number];
      if (luminaire.is_image()) continue;
      const Beam beam = beam_of(luminaire);
      const std::uint64_t key = stream_key(seed, kLuminaireRays, number);
      for (std::size_t k = 0; k < rays_each; ++k) {
        const auto u = sobol4(static_cast<std::uint32_t>(k), key);
        const Vec3 d = direction_in(beam, u[0], u[1]), start = ray_start(luminaire, luminaire.position, d);
        RandomStream random = echo_numbers(key, k);
        if (!intensity(luminaire, d).is_black())
          met[number * rays_each + k] = one_way(problem.rays, problem.patches, {start, d}, random).patch;
      }
    }
  });
  for (std::size_t number = 0; number < count; ++number)
    spaces.light(problem.patches, std::span(met).subspan(number * rays_each, rays_each));
}

/// Sides that rays through the openings meet: of a room behind a slit no ray of its own may find it.
void light_by_openings(const Problem& problem, std::uint64_t seed, Spaces& spaces) {
  constexpr std::uint32_t kRays = 64;
  for (std::size_t k = 0; k < problem.lights.openings.size(); ++k) {
    const LightArea& opening = problem.lights.openings[k];
    const std::uint64_t key = stream_key(seed, kOpeningRays, k);
    std::vector<PatchId> met;
    for (std::uint32_t r = 0; r < kRays; ++r) {
      const Ray ray = ray_through(opening, opening.normal, key, r, problem.rays.lift());
      met.push_back(problem.rays.first_hit(problem.patches, ray).patch);
    }
    spaces.light(problem.patches, met);
  }
}

/// Lets the given patches look for luminaires and for the patches that glow.
void search_lights(const Problem& problem, const Field& glow, const std::vector<std::uint32_t>& receivers,
                   std::size_t samples, std::uint64_t seed, const Monitor& monitor, Spaces& spaces) {
  const LightSampler emitters(problem, glow);
  // So that the effort has a bound.
  constexpr std::size_t kMostPairs = 1 << 20;
  const std::size_t stride = 1 + receivers.size() * problem.lights.luminaires.size() / kMostPairs;
  for (std::size_t begin = 0; begin < receivers.size() && !monitor.should_stop(); begin += kBlock) {
    std::vector<Found> found(std::min(kBlock, receivers.size() - begin));
    parallel_for(found.size(), 32, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k)
        found[k] = look_for_lights(problem, emitters, receivers[begin + k], stride, samples, seed);
    });
    for (std::size_t k = 0; k < found.size(); ++k) {
      if (found[k].lit) spaces.light(receivers[begin + k]);
      for (const PatchId q : found[k].glowing) spaces.see_each_other(problem.patches, receivers[begin + k], q);
    }
  }
}

}  // namespace

LitSides find_lit_sides(const Problem& problem, std::uint64_t seed, const Monitor& monitor) {
  const PatchSet& patches = problem.patches;
  const std::size_t n = patches.patch_count();
  // Enough rays in all that a space of few large patches is not taken apart by chance.
  const int ray_count = 16 * static_cast<int>(std::clamp<std::size_t>((1 << 15) / std::max<std::size_t>(n, 1), 1, 16));

  Spaces spaces(patches);
  for (std::size_t i = 0; i < n; ++i)
    for (const PatchSet::Behind& other : patches.patches_behind(i)) spaces.see_each_other(patches, i, other.patch);
  light_by_luminaires(problem, seed, spaces);
  light_by_openings(problem, seed, spaces);

  // Emitters first: most patches of a large scene are then met by a ray before it is their turn, and send none, or meet
  // a space that takes part with their first ray.
  std::vector<std::uint32_t> waiting;
  waiting.reserve(n);
  for (const bool emitting : {true, false})
    for (std::uint32_t i = 0; i < n; ++i)
      if (patches.M[i].is_black() != emitting) waiting.push_back(i);
  std::vector<std::uint32_t> looking;
  for (std::size_t next = 0; next < n;) {
    if (monitor.should_stop()) {  // what was not looked at takes part
      for (; next < n; ++next) spaces.light(waiting[next]);
      break;
    }
    looking.clear();
    for (; next < n && looking.size() < kBlock; ++next)
      if (!spaces.is_settled(waiting[next])) looking.push_back(waiting[next]);
    std::vector<Seen> seen(looking.size());
    parallel_for(seen.size(), 32, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) seen[k] = look_around(problem, spaces, looking[k], ray_count, seed);
    });
    for (std::size_t k = 0; k < seen.size(); ++k) {
      for (const PatchId q : seen[k].patches) spaces.see_each_other(patches, looking[k], q);
      if (seen[k].sun || (seen[k].outside && problem.lights.sky)) spaces.light_outdoors(patches, looking[k]);
    }
  }
  waiting = {};

  // In the open a patch may see nothing but luminaires, which rays seldom meet.
  std::vector<std::uint32_t> in_doubt, in_glow;
  Field lonely(n, patches.channels);  // emitters that have not met what they light
  bool any_lonely = false;
  for (std::uint32_t i = 0; i < n; ++i) {
    if (spaces.is_lit(i)) continue;
    (spaces.is_settled(i) ? in_glow : in_doubt).push_back(i);
    if (spaces.is_settled(i) || patches.M[i].is_black()) continue;
    lonely.set(i, patches.M[i]);
    any_lonely = true;
  }
  search_lights(problem, patches.M, in_doubt, kLuminaireSamples, seed, monitor, spaces);
  if (any_lonely) {
    // Seldom: the inside of a luminaire, which no one finds, or a luminaire in the open. So the effort has a bound.
    const std::size_t samples =
        std::clamp<std::size_t>((1 << 22) / std::max<std::size_t>(in_glow.size(), 1), 1, kLuminaireSamples);
    search_lights(problem, lonely, in_glow, samples, seed, monitor, spaces);
  }

  std::vector<char> lights_others(patches.materials.size(), 0);
  for (std::size_t i = 0; i < n; ++i)
    if (!patches.M[i].is_black() && !spaces.only_material(i).valid()) lights_others[patches.material(PatchId{i})] = 1;

  // Of a wide luminaire in the open only the part nearby may have found what it lights.
  std::vector<std::uint32_t> emitting;
  for (std::uint32_t i = 0; i < n; ++i)
    if (!patches.M[i].is_black()) emitting.push_back(i);
  std::vector<char> goes_on(n, 0);
  for (const auto& group : plane_groups(patches, emitting))
    if (std::ranges::any_of(group, [&](std::uint32_t i) { return !spaces.only_material(i).valid(); }))
      for (const std::uint32_t i : group) goes_on[i] = 1;

  LitSides result;
  result.wanted.assign(2 * patches.triangle_count(), false);
  result.space.resize(2 * patches.triangle_count());
  for (std::size_t i = 0; i < n; ++i) {
    const bool lit = spaces.is_lit(i), glows = spaces.glows(i);
    const MaterialId only = spaces.only_material(i);
    const bool inside_luminaire = !lit && glows && only.valid() && lights_others[only];
    const std::size_t number = 2 * patches.triangle[i] + patches.side[i];
    result.space[number] = spaces.name(i);
    if (lit || goes_on[i] || (glows && !inside_luminaire))
      result.wanted[number] = true;
    else
      ++(inside_luminaire ? result.luminaire_interiors : result.dark_sides);
  }
  return result;
}

}  // namespace clerestory
