#include "solver/paths/path_place.h"

#include <algorithm>
#include <numbers>

#include "solver/model/units.h"
#include "solver/paths/way_on.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

/// What a cosine counts as at least: rays in float meet surfaces that they run along.
constexpr double kGrazing = 1e-9;

}  // namespace

Spectrum PathPlace::reflects(const Vec3& d) const {
  return lobe ? diffuse + std::numbers::pi * lobe->evaluate(n, back, d) : diffuse;
}

PathArrival arrival_of(const Problem& problem, const Hit& hit, const Ray& ray) {
  PathArrival at;
  at.n = problem.patches.normal[hit.patch];
  at.on = in_plane_of(problem.patches, hit.patch, hit.position(ray));
  at.x = problem.rays.off_surface(at.on, at.n);
  at.back = -hit.direction(ray);
  at.cosine = std::max(dot(at.n, at.back), kGrazing);
  return at;
}

PathPlace place_of(const Problem& problem, const Hit& hit, const PathArrival& arrival, RandomStream& random) {
  const PatchSet& patches = problem.patches;
  const auto on = patches.scatter(hit.patch, patches.scatters_through(hit.patch) ? random.uniform() : 0);
  PathPlace at;
  at.n = on.normal;
  at.x = problem.rays.off_surface(arrival.on, on.normal);
  at.back = arrival.back;
  at.diffuse = on.share;
  at.lobe = problem.rays.lobe(hit.triangle, -arrival.back);
  if (at.lobe) {
    const double lobe = luminous_mean(at.lobe->specular()), all = lobe + luminous_mean(at.diffuse);
    at.by_lobe = all > 0 ? lobe / all : 0;
  }
  return at;
}

PathWay way_from_eye(const Illumination& light, const PathPlace& at, const std::array<double, 2>& square,
                     RandomStream& random) {
  if (at.lobe && random.uniform() < at.by_lobe) {
    const Lobe::Sample s = at.lobe->sample(at.n, at.back, square[0], square[1]);
    if (!(s.density > 0)) return {};
    const double density = at.density(s.direction, density_of_ways(light, at.x, at.n, s.direction));
    return {s.direction, density, at.reflects(s.direction) * (dot(at.n, s.direction) / (std::numbers::pi * density)),
            1};
  }
  const WayOn way = way_on(light, at.x, at.n, square, random);
  if (!(way.factor > 0)) return {};
  const double density = at.density(way.direction, way.density);
  return {way.direction, density, at.reflects(way.direction) * (way.factor * way.density / density),
          way.by_slit ? std::min(1.0, way.factor) : 1};
}

PathWay way_from_light(const PathPlace& at, RandomStream& random) {
  const bool by_lobe = at.lobe && random.uniform() < at.by_lobe;
  const double u = random.uniform(), v = random.uniform();
  const Vec3 d = by_lobe ? at.lobe->sample(at.n, at.back, u, v).direction : cosine_direction(Frame(at.n), u, v);
  const double cosine = dot(at.n, d);
  if (!(cosine > 0)) return {};
  const double density = at.density(d, cosine / std::numbers::pi);
  return {d, density, at.reflects(d) * (cosine / (std::numbers::pi * density)), 1};
}

}  // namespace clerestory
