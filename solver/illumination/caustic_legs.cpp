#include "solver/illumination/caustic_legs.h"

#include <algorithm>
#include <cmath>

#include "solver/geometry/triangle.h"
#include "solver/illumination/one_light.h"
#include "solver/lights/luminaire.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/sampling/cumulative_table.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

constexpr int kMostLegs = 256;
constexpr double kMuch = 0.1;         // of a particle's first flux: below it roulette ends the way
constexpr double kByAreaAlone = 0.1;  // share of the particles, so that no side is forgotten that is lit at its rim
constexpr std::size_t kBlock = 1 << 9, kRound = 64;  // particles of a task; tasks between looks at the monitor
constexpr std::size_t kMostOfParticle = 3;  // legs in the mean: a light pipe has fewer particles rather than more

std::array<float, 3> floats(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
std::array<float, 3> floats(const Spectrum& s) {
  return {static_cast<float>(s[0]), static_cast<float>(s[1]), static_cast<float>(s[2])};
}

double area_of(const CausticSide& side) {
  const auto& [a, b, c] = side.corners;
  return length(cross(b - a, c - a)) / 2;
}

const Lobe* lobe_of(const RayScene& rays, const CausticSide& side) { return rays.lobe(side.triangle, -side.normal); }

/// What the lights send on from each side where nothing blocks, about [W]; of many lights by some of them.
void weigh(const Problem& problem, std::vector<CausticSide>& sides) {
  constexpr std::uint32_t kMostLights = 64;
  const Lights& lights = problem.lights;
  const auto count = static_cast<std::uint32_t>(lights.luminaires.size() + lights.suns.size());
  const LightChoice choice = choice_of_lights(problem);
  const auto open = [&](std::uint32_t light, const Vec3& x, const Vec3& n) {
    if (is_sun(lights, light)) {
      const PlacedSun& sun = sun_of(lights, light);
      return sun.share * luminous_mean(sun.normal_irradiance) * std::max(0.0, dot(n, sun.direction));
    }
    const PlacedLuminaire& luminaire = lights.luminaires[light];
    return luminaire.share * luminous_mean(open_irradiance(luminaire, x, n));
  };
  parallel_for(sides.size(), 16, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      CausticSide& side = sides[k];
      const Vec3 middle = (side.corners[0] + side.corners[1] + side.corners[2]) / 3;
      double E = 0;
      for (std::uint32_t i = 0; i < std::min(count, kMostLights); ++i) {
        if (count <= kMostLights) {
          E += open(i, middle, side.normal);
          continue;
        }
        const LightTree::Choice some = choice.choose(middle, side.normal, (i + 0.5) / kMostLights);
        if (some.probability > 0) E += open(some.light, middle, side.normal) / (some.probability * kMostLights);
      }
      const Lobe* lobe = lobe_of(problem.rays, side);
      side.weight = E * area_of(side) * luminous_mean(lobe ? lobe->specular() : side.mirror);
    }
  });
  double all = 0, area = 0;
  for (const CausticSide& side : sides) all += side.weight, area += area_of(side);
  for (CausticSide& side : sides) side.weight += kByAreaAlone * all * area_of(side) / area;
}

CumulativeTable choice_of_sides(const std::vector<CausticSide>& sides) {
  std::vector<double> weight;
  for (const CausticSide& side : sides) weight.push_back(side.weight);
  return CumulativeTable(weight);
}

/// A particle where it leaves the first side that turns it.
struct Start {
  Ray ray;
  Spectrum flux{0.0};
  std::uint32_t light = 0;
};

class Source {
 public:
  explicit Source(const Problem& problem)
      : problem_(problem), sides_(choice_of_sides(problem.lights.caustics.sides)), lights_(choice_of_lights(problem)) {}

  bool empty() const { return sides_.empty(); }

  Start send(const std::array<double, 4>& u, const std::array<double, 4>& v) const {
    const auto [number, probability, rest] = sides_.choose(u[0]);
    const CausticSide& side = problem_.lights.caustics.sides[number];
    const Vec3& n = side.normal;
    const Vec3 x = problem_.rays.off_surface(point_on_triangle(side.corners, u[1], u[2]), n);
    const LightTree::Choice choice = lights_.choose(x, n, u[3]);
    if (!(choice.probability > 0)) return {};
    const auto [to_light, E] =
        light_from_point(problem_, choice.light, point_of_light(problem_.lights, choice.light, v[0], v[1]), x, n);
    if (E.is_black()) return {};
    Start start{{x, {}}, E * (area_of(side) / (probability * choice.probability)), choice.light};
    if (const Lobe* lobe = lobe_of(problem_.rays, side)) {
      const Lobe::Sample s = lobe->sample(n, to_light, v[2], v[3]);
      start.ray.direction = s.direction;
      start.flux *= s.density > 0 ? s.weight : Spectrum(0.0);
    } else {
      start.ray.direction = n * (2 * dot(n, to_light)) - to_light;
      start.flux *= side.mirror;
    }
    return start;
  }

 private:
  const Problem& problem_;
  CumulativeTable sides_;
  LightChoice lights_;
};

/// legs: of a whole particle's flux.
void follow(const Problem& problem, const Start& start, RandomStream random, std::vector<CausticLeg>& legs) {
  const RayScene& rays = problem.rays;
  Ray ray = start.ray;
  Spectrum flux = start.flux;
  const double least = kMuch * luminous_mean(flux);
  for (int leg = 0; leg < kMostLegs && luminous_mean(flux) > 0; ++leg) {
    Echo echo;
    const Hit hit = rays.first_leg(problem.patches, ray, echo);
    const Vec3 end = hit.escaped() ? ray.origin + ray.direction * (2 * rays.diameter()) : hit.position(ray);
    CausticLeg to{floats(ray.origin), floats(end), floats(flux), start.light, hit.triangle, false, {}};
    if (!hit.escaped()) {
      to.on_front = dot(rays.normal(hit.triangle), ray.direction) < 0;
      const auto [u, v] = rays.barycentric(hit.triangle, end);
      to.uv = {static_cast<float>(u), static_cast<float>(v)};
    }
    legs.push_back(to);
    flux *= echo.share;
    const double chance = luminous_mean(flux) / least;
    if (!(random.uniform() < chance)) return;
    flux *= 1 / std::min(1.0, chance);
    ray = echo.ray;
  }
}

std::vector<CausticSide> caustic_sides(const Problem& problem, bool with_gloss) {
  const auto& [patches, rays, lights] = problem;
  std::vector<CausticSide> sides;
  if ((lights.luminaires.empty() && lights.suns.empty()) || (!rays.has_mirrors() && !rays.has_gloss())) return sides;
  for (std::size_t i = 0; i < patches.triangle_count(); ++i) {
    const TriangleId t{i};
    const Material& material = patches.front_material(t);
    const bool is_mirror = material.turns_rays() && rays.plane_of(t) == kNoPlane;
    if (!(length(rays.normal(t)) > 0.5)) continue;  // without area
    for (const Side side : {kFront, kBack}) {
      if (!is_mirror && !(with_gloss && rays.gloss().narrow_without_plane(t, side))) continue;
      CausticSide& to = sides.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) to.corners[k] = patches.vertices[patches.corners[t][k]];
      to.normal = side == kFront ? rays.normal(t) : -rays.normal(t);
      to.triangle = t;
      if (is_mirror) to.mirror = material.reflectance;
    }
  }
  return sides;
}

}  // namespace

std::vector<CausticLeg> trace_caustics(const Problem& problem, std::size_t particles, std::uint64_t key,
                                       const Monitor& monitor) {
  const Source source(problem);
  std::vector<CausticLeg> legs;
  if (source.empty()) return legs;
  std::size_t sent = 0;
  // The first round gets its time: without it there would be nothing to show.
  while (sent < particles && (sent == 0 || !monitor.should_stop()) && legs.size() < kMostOfParticle * particles) {
    const std::size_t count = std::min(particles - sent, kBlock * kRound), blocks = (count + kBlock - 1) / kBlock;
    std::vector<std::vector<CausticLeg>> of_block(blocks);
    parallel_for(blocks, 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t b = from; b < to; ++b)
        for (std::size_t i = sent + b * kBlock; i < sent + std::min((b + 1) * kBlock, count); ++i) {
          const auto k = static_cast<std::uint32_t>(i);
          follow(problem, source.send(sobol4(k, key), sobol4(k, key + 1)), RandomStream(key, i), of_block[b]);
        }
    });
    for (const auto& block : of_block) legs.insert(legs.end(), block.begin(), block.end());
    sent += count;
  }
  const auto share = static_cast<float>(1 / static_cast<double>(std::max<std::size_t>(sent, 1)));
  for (CausticLeg& leg : legs)
    for (float& flux : leg.flux) flux *= share;
  return legs;
}

Caustics find_caustics(const Problem& problem, std::size_t particles, std::size_t legs_of_point, std::uint64_t seed,
                       const Monitor& monitor, bool with_gloss) {
  Caustics found;
  found.sides = caustic_sides(problem, with_gloss);
  if (found.sides.empty()) return found;
  weigh(problem, found.sides);
  Lights lights = problem.lights;
  lights.caustics = found;
  found.legs = trace_caustics({problem.patches, problem.rays, lights}, particles, stream_key(seed, kCaustics), monitor);
  found.particles = particles, found.legs_of_point = legs_of_point;
  return found;
}

PatchId patch_of(const PatchSet& patches, const CausticLeg& leg) {
  if (!leg.triangle.valid()) return {};
  return patches.patch_at(leg.triangle, leg.on_front ? kFront : kBack, double{leg.uv[0]}, double{leg.uv[1]});
}

CausticLanding landing_of(const Problem& problem, const CausticLeg& leg) {
  const PatchId patch = patch_of(problem.patches, leg);
  if (!patch.valid()) return {};
  const Vec3 from = leg.start(), to = leg.end();
  return {patch, to, normalized(to - from), leg.light, leg.sent() * problem.rays.glass_transmittance(from, to)};
}

Field caustics_on_patches(const Problem& problem, std::span<const CausticLeg> legs) {
  Field E(problem.patches.patch_count(), problem.patches.channels);
  each_landing(problem, legs, [&](const CausticLanding& l) { E.add(l.patch, l.flux / problem.patches.area[l.patch]); });
  return E;
}

}  // namespace clerestory
