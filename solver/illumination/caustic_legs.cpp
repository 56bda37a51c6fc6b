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
constexpr double kMuch = 0.1;           // of a particle's first flux: below it roulette ends the way
constexpr double kByAreaAlone = 0.1;    // share of the particles, so that no side is forgotten that is lit at its rim
constexpr std::size_t kBlock = 1 << 9;  // particles of a task

std::array<float, 3> floats(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
std::array<float, 3> floats(const Spectrum& s) {
  return {static_cast<float>(s[0]), static_cast<float>(s[1]), static_cast<float>(s[2])};
}
Vec3 vec(const std::array<float, 3>& v) { return {double{v[0]}, double{v[1]}, double{v[2]}}; }

double area_of(const CausticSide& side) {
  const auto& [a, b, c] = side.corners;
  return length(cross(b - a, c - a)) / 2;
}

const Lobe* lobe_of(const RayScene& rays, const CausticSide& side) { return rays.lobe(side.triangle, -side.normal); }

/// What the lights send on from each side where nothing blocks, about [W].
std::vector<double> turned_by(const Problem& problem) {
  const Lights& lights = problem.lights;
  std::vector<double> turned(lights.caustics.sides.size());
  parallel_for(turned.size(), 16, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      const CausticSide& side = lights.caustics.sides[k];
      const Vec3 middle = (side.corners[0] + side.corners[1] + side.corners[2]) / 3;
      double E = 0;
      for (const PlacedLuminaire& luminaire : lights.luminaires)
        E += luminaire.share * luminous_mean(open_irradiance(luminaire, middle, side.normal));
      for (const PlacedSun& sun : lights.suns)
        E += sun.share * luminous_mean(sun.normal_irradiance) * std::max(0.0, dot(side.normal, sun.direction));
      const Lobe* lobe = lobe_of(problem.rays, side);
      turned[k] = E * area_of(side) * luminous_mean(lobe ? lobe->specular() : side.mirror);
    }
  });
  return turned;
}

CumulativeTable choice_of_sides(const Problem& problem) {
  std::vector<double> weight = turned_by(problem);
  double all = 0, area = 0;
  for (std::size_t k = 0; k < weight.size(); ++k) all += weight[k], area += area_of(problem.lights.caustics.sides[k]);
  if (!(all > 0)) return {};
  for (std::size_t k = 0; k < weight.size(); ++k)
    weight[k] += kByAreaAlone * all * area_of(problem.lights.caustics.sides[k]) / area;
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
      : problem_(problem), sides_(choice_of_sides(problem)), lights_(choice_of_lights(problem)) {}

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

void follow(const Problem& problem, const Start& start, RandomStream random, double per_particle,
            std::vector<CausticLeg>& legs) {
  const RayScene& rays = problem.rays;
  Ray ray = start.ray;
  Spectrum flux = start.flux;
  const double least = kMuch * luminous_mean(flux);
  for (int leg = 0; leg < kMostLegs && luminous_mean(flux) > 0; ++leg) {
    Echo echo;
    const Hit hit = rays.first_leg(problem.patches, ray, echo);
    const Vec3 end = hit.escaped() ? ray.origin + ray.direction * (2 * rays.diameter()) : hit.position(ray);
    CausticLeg to{floats(ray.origin), floats(end), floats(flux * per_particle), start.light, hit.triangle, false, {}};
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
  if (source.empty() || particles == 0) return {};
  const std::size_t blocks = (particles + kBlock - 1) / kBlock;
  std::vector<std::vector<CausticLeg>> of_block(blocks);
  parallel_for(blocks, 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t b = from; b < to && !monitor.should_stop(); ++b)
      for (std::size_t i = b * kBlock; i < std::min((b + 1) * kBlock, particles); ++i) {
        const auto k = static_cast<std::uint32_t>(i);
        follow(problem, source.send(sobol4(k, key), sobol4(k, key + 1)), RandomStream(key, i),
               1 / static_cast<double>(particles), of_block[b]);
      }
  });
  if (monitor.should_stop()) return {};
  std::vector<CausticLeg> legs;
  std::size_t count = 0;
  for (const auto& block : of_block) count += block.size();
  legs.reserve(count);
  for (const auto& block : of_block) legs.insert(legs.end(), block.begin(), block.end());
  return legs;
}

Caustics find_caustics(const Problem& problem, std::size_t particles, std::size_t legs_of_point, std::uint64_t seed,
                       const Monitor& monitor, bool with_gloss) {
  Caustics found;
  found.sides = caustic_sides(problem, with_gloss);
  if (found.sides.empty()) return found;
  Lights lights = problem.lights;
  lights.caustics = found;
  found.legs = trace_caustics({problem.patches, problem.rays, lights}, particles, stream_key(seed, kCaustics), monitor);
  found.particles = particles, found.legs_of_point = legs_of_point;
  return found;
}

CausticLanding landing_of(const Problem& problem, const CausticLeg& leg) {
  if (!leg.triangle.valid()) return {};
  const PatchId patch =
      problem.patches.patch_at(leg.triangle, leg.on_front ? kFront : kBack, double{leg.uv[0]}, double{leg.uv[1]});
  if (!patch.valid()) return {};
  const Vec3 from = vec(leg.from), to = vec(leg.to);
  const Spectrum flux(double{leg.flux[0]}, double{leg.flux[1]}, double{leg.flux[2]});
  return {patch, to, normalized(to - from), leg.light, flux * problem.rays.glass_transmittance(from, to)};
}

Field caustics_on_patches(const Problem& problem, std::span<const CausticLeg> legs) {
  Field E(problem.patches.patch_count(), problem.patches.channels);
  each_landing(problem, legs, [&](const CausticLanding& l) { E.add(l.patch, l.flux / problem.patches.area[l.patch]); });
  return E;
}

}  // namespace clerestory
