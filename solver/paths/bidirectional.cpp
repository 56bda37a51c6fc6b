#include "solver/paths/bidirectional.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "solver/lights/luminaire.h"
#include "solver/lights/near_planes.h"
#include "solver/lights/sun.h"
#include "solver/model/units.h"
#include "solver/paths/path_balance.h"
#include "solver/paths/way_on.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/echoes.h"

namespace clerestory {
namespace {

/// A path from the receiver is not ended while it carries more than this of what it started with.
constexpr double kSafe = 0.3;
/// A particle goes on from a surface with its albedo for the chance, and no more than this, so that their number has a
/// bound where surfaces absorb nothing.
constexpr double kMostSurvival = 0.95;
/// What the choice of an opening and the ray through it cost, in rays.
constexpr unsigned kCostOfOpening = 3;
/// What a cosine counts as at least: rays in float meet surfaces that they run along.
constexpr double kGrazing = 1e-9;

/// A place on a surface where a particle was scattered.
struct ParticleVertex {
  Vec3 x, n;        ///< off the surface, on the side that the particle leaves to
  Spectrum flux;    ///< that leaves [W]
  double survival;  ///< chance with which it goes on
  double beyond;    ///< joints_beyond()
};

/// From x, at cosine cos_x, back to p, as PathPart wants it. d2: squared distance, straight where the way is not.
PathPart path_part(double density_of_way, double cos_p, double cos_x, double d2, double survival, bool can_join) {
  return {density_of_way * cos_x / d2, survival * (cos_x / std::numbers::pi) * cos_p / d2, can_join};
}

double square(const Vec3& a) { return dot(a, a); }

/// Both ends of a problem, for one path.
class BothEnds {
 public:
  BothEnds(const Illumination& light, const Emission& emission, unsigned long long& rays)
      : light_(light), emission_(emission), scene_(light.problem.rays), patches_(light.problem.patches), rays_(rays) {}

  /// The places of a particle. pick, u: as of Emission::sample().
  std::vector<ParticleVertex> particle(double pick, const std::array<double, 4>& u, RandomStream& random) const;

  /// Light at point p with normal n, of a path from the receiver that has `before` as its joints_before().
  Spectrum by_shadow_ray(const Vec3& p, const Vec3& n, double before, const std::array<double, 3>& u) const;
  Spectrum through_opening(const Vec3& p, const Vec3& n, double before, const std::array<double, 3>& u) const;
  Spectrum joined(const Vec3& p, const Vec3& n, double before, const ParticleVertex& y) const;

  double survival(PatchId p) const { return std::min(patches_.albedo(p).max(), kMostSurvival); }

  /// The end of a path at point p: the sky in direction d, met by `hit`, or a patch that glows.
  PathEnd end_in_sky(const Vec3& p, const Vec3& n, const Vec3& d, double density_of_way, const Hit& hit) const {
    const Ray back = hit.reflected ? hit.leg : Ray{p, d};
    const double by_opening = hit.reflected || light_.openings.empty() ? 0 : light_.openings.preference(p, n, d);
    return {density_of_way, by_opening, emission_.density_of_sky(back.origin, -back.direction) * dot(n, d)};
  }
  PathEnd end_on_patch(PatchId q, const Vec3& n, const Vec3& d, double density_of_way, double by_shadow_ray) const {
    return {density_of_way, by_shadow_ray, emission_.density_of_patch(q) * dot(n, d) / std::numbers::pi};
  }

 private:
  struct FirstLeg {
    Ray ray;
    Hit hit;
    Spectrum flux{0.0};
  };
  FirstLeg first_leg(const Emitted& e, const std::array<double, 4>& u, RandomStream& random) const;
  FirstLeg leg(const Ray& ray, const Spectrum& flux, RandomStream& random) const;
  PathEnd end_of_particle(const Emitted& e, const FirstLeg& first, const Vec3& x, const Vec3& n) const;
  Vec3 off_patch(const Hit& hit, const Ray& ray, const Vec3& n) const {
    return scene_.off_surface(in_plane_of(patches_, hit.patch, hit.position(ray)), n);
  }

  const Illumination& light_;
  const Emission& emission_;
  const RayScene& scene_;
  const PatchSet& patches_;
  unsigned long long& rays_;
};

BothEnds::FirstLeg BothEnds::leg(const Ray& ray, const Spectrum& flux, RandomStream& random) const {
  FirstLeg first{ray, one_way(scene_, patches_, ray, random)};
  ++rays_;
  if (first.hit.patch.valid()) first.flux = flux * first.hit.transmittance;
  return first;
}

/// Where a particle first falls. Luminaires shine from all over their opening near by and from its middle farther away:
/// it is sent from both, and counts where that is where it comes from.
BothEnds::FirstLeg BothEnds::first_leg(const Emitted& e, const std::array<double, 4>& u, RandomStream& random) const {
  if (e.light >= light_.problem.lights.luminaires.size()) {
    FirstLeg first = leg(e.ray, e.flux, random);
    const bool is_sun = e.light != Emitted::kNone;
    if (is_sun && first.hit.reflected) first.flux = Spectrum(0.0);  // its image's
    return first;
  }
  const PlacedLuminaire& luminaire = light_.problem.lights.luminaires[e.light];
  const Vec3& d = e.ray.direction;
  const auto from = [&](const Vec3& q) {
    FirstLeg first = leg({ray_start(luminaire, q, d), d}, e.flux, random);
    if (first.flux.is_black()) return first;
    const Vec3 x = first.hit.position(first.ray);
    if (first.hit.reflected || light_point(luminaire, x, u[0], u[1]) != q) first.flux = Spectrum(0.0);
    // At points luminaires do not dazzle: less arrives very near them.
    const double r2 = square(x - q);
    const double whole = luminous_mean(intensity(luminaire, d)) / r2;
    const double arrives = luminous_mean(open_irradiance(luminaire, q, q + d * std::sqrt(r2), -d));
    if (whole > 0) first.flux *= std::min(1.0, arrives / whole);
    return first;
  };
  const Vec3 q = light_point(luminaire, luminaire.position, u[0], u[1]);
  FirstLeg near = from(q);
  if (q == luminaire.position) return near;
  FirstLeg far = from(luminaire.position);
  if (near.flux.is_black()) return far;
  if (far.flux.is_black()) return near;
  FirstLeg& one = random.uniform() < 0.5 ? near : far;
  one.flux *= 2;
  return one;
}

PathEnd BothEnds::end_of_particle(const Emitted& e, const FirstLeg& first, const Vec3& x, const Vec3& n) const {
  const Vec3 d = -first.hit.direction(first.ray);
  const double cosine = std::max(dot(n, d), kGrazing);
  if (e.patch.valid()) {
    const bool can_choose = !first.hit.reflected && light_.sampler.is_bright(e.patch);
    const double to_patch = can_choose
                                ? light_.sampler.density(e.patch, light_.sampler.receiver(x, n), first.hit.distance,
                                                         dot(patches_.normal[e.patch], first.ray.direction), false)
                                : 0;
    return {density_of_ways(light_, x, n, d), to_patch, e.density_place * cosine / std::numbers::pi};
  }
  if (e.is_sky()) {
    const double by_opening = first.hit.reflected || light_.openings.empty() ? 0 : light_.openings.preference(x, n, d);
    return {density_of_ways(light_, x, n, d), by_opening, e.density_place * e.density_direction * cosine};
  }
  const double by_shadow_ray = light_.sampler.probability(e.light, x, n);
  if (e.light >= light_.problem.lights.luminaires.size()) return {0, by_shadow_ray, e.density_place * cosine};
  return {0, by_shadow_ray,
          e.density_place * e.density_direction * cosine / square(first.hit.position(first.ray) - first.ray.origin)};
}

std::vector<ParticleVertex> BothEnds::particle(double pick, const std::array<double, 4>& u,
                                               RandomStream& random) const {
  std::vector<ParticleVertex> vertices;
  if (emission_.empty()) return vertices;
  const Emitted e = emission_.sample(pick, u);
  if (e.flux.is_black()) return vertices;
  const FirstLeg first = first_leg(e, u, random);
  Spectrum flux = first.flux;
  if (flux.is_black()) return vertices;
  Hit hit = first.hit;
  Ray ray = first.ray;
  for (;;) {
    const Vec3& arrives_on = patches_.normal[hit.patch];
    const Vec3 in_plane = in_plane_of(patches_, hit.patch, hit.position(ray));
    const double cos_in = std::max(-dot(arrives_on, hit.direction(ray)), kGrazing);
    double beyond;
    if (vertices.empty()) {
      const PathEnd end = end_of_particle(e, first, scene_.off_surface(in_plane, arrives_on), arrives_on);
      beyond = end.beyond();
    } else {
      // From the receiver this part is gone the other way.
      const ParticleVertex& last = vertices.back();
      const double cos_last = dot(last.n, ray.direction);
      const double way =
          density_of_ways(light_, scene_.off_surface(in_plane, arrives_on), arrives_on, -hit.direction(ray));
      beyond = joints_beyond(path_part(way, cos_in, cos_last, square(in_plane - last.x), last.survival, !hit.reflected),
                             last.beyond);
    }
    const auto on = patches_.scatter(hit.patch, patches_.scatters_through(hit.patch) ? random.uniform() : 0);
    flux *= on.share;
    if (flux.is_black()) return vertices;
    vertices.push_back({scene_.off_surface(in_plane, on.normal), on.normal, flux, survival(hit.patch), beyond});
    const ParticleVertex& here = vertices.back();
    if (!(random.uniform() < here.survival)) return vertices;
    flux *= 1 / here.survival;
    const double a = random.uniform(), b = random.uniform();
    ray = {here.x, cosine_direction(Frame(here.n), a, b)};
    hit = one_way(scene_, patches_, ray, random);
    ++rays_;
    if (!hit.patch.valid()) return vertices;
    flux *= hit.transmittance;
  }
}

Spectrum BothEnds::by_shadow_ray(const Vec3& p, const Vec3& n, double before, const std::array<double, 3>& u) const {
  const LightSample s = light_.sampler.sample(light_.sampler.receiver(p, n), u[0], u[1], u[2], false);
  if (s.irradiance.is_black()) return s.irradiance;
  double weight = 1;
  const Vec3 to = s.end - p, d = normalized(to);
  const double cosine = dot(n, d);
  const std::size_t luminaires = light_.problem.lights.luminaires.size();
  if (s.patch.valid()) {
    const PathEnd end = end_on_patch(s.patch, n, d, density_of_ways(light_, p, n, d), s.density);
    weight = end.shadow_ray / end.all(before);
  } else if (s.way.empty() && before > 0) {
    PathEnd end{0, s.probability};
    if (s.light < luminaires) {
      end.from_light = emission_.probability_of_luminaire(s.light) * emission_.density_of_direction(s.light, -d) *
                       cosine / square(to);
    } else {
      const Sun& sun = light_.problem.lights.suns[s.light - luminaires];
      end.from_light = emission_.density_of_sun(s.light, p, -d) / density_in_disc(sun, d) * cosine;
    }
    weight = end.shadow_ray / end.all(before);
  }
  ++rays_;
  return s.irradiance * weight * scene_.transmittance_by_mirrors(p, s.end, s.way);
}

Spectrum BothEnds::through_opening(const Vec3& p, const Vec3& n, double before, const std::array<double, 3>& u) const {
  const OpeningSampler::Sample s = light_.openings.sample(p, n, u[0], u[1], u[2]);
  const double cosine = dot(n, s.direction);
  if (!(s.per_choice > 0) || !(cosine > 0)) return Spectrum(0.0);
  rays_ += kCostOfOpening;
  const Spectrum passes = scene_.transmittance(p, p + s.direction * (4 * scene_.diameter()));
  if (passes.is_black()) return passes;
  const PathEnd end{density_of_ways(light_, p, n, s.direction),
                    s.preference + light_.openings.preference(p, n, s.direction, s.opening),
                    emission_.density_of_sky(p, -s.direction) * cosine};
  return light_.sky(s.direction) * passes * (cosine * s.per_choice * s.preference / end.all(before));
}

Spectrum BothEnds::joined(const Vec3& p, const Vec3& n, double before, const ParticleVertex& y) const {
  const Vec3 to = y.x - p;
  const double d2 = square(to), cos_p_r = dot(n, to), cos_y_r = -dot(y.n, to);
  if (!(cos_p_r > 0 && cos_y_r > 0)) return Spectrum(0.0);
  const double r = std::sqrt(d2), cos_p = cos_p_r / r, cos_y = cos_y_r / r;
  const PathPart part = path_part(density_of_ways(light_, p, n, to / r), cos_p, cos_y, d2, y.survival, true);
  ++rays_;
  return y.flux * scene_.transmittance(p, y.x) *
         (cos_p * cos_y / (std::numbers::pi * d2) * weight_of_joint(part, before, y.beyond));
}

}  // namespace

Spectrum Bidirectional::trace(Vec3 p, Vec3 n, const PathStart& start, RandomStream& random, unsigned long long& rays,
                              const Monitor& monitor) const {
  const PatchSet& patches = light_.problem.patches;
  const BothEnds ends(light_, emission_, rays);
  const auto u = sobol4(start.number, start.key + 3);
  const std::vector<ParticleVertex> particle = ends.particle(sobol4(start.number, start.key + 4)[0], u, random);

  Spectrum E(0.0), throughput(1.0);
  double before = 0;
  double through_slits = 1;  // what they leave; no reason to end a path that was sent there
  auto [square_of_way, choice, opening, number, key] = start;
  constexpr unsigned kBouncesBetween = 1 << 10;
  for (unsigned bounce = 1;; ++bounce) {
    if (bounce % kBouncesBetween == 0 && monitor.should_stop()) return E;
    if (!light_.sampler.empty()) E += throughput * ends.by_shadow_ray(p, n, before, choice);
    if (!light_.openings.empty()) E += throughput * ends.through_opening(p, n, before, opening);
    for (const ParticleVertex& y : particle) E += throughput * ends.joined(p, n, before, y);
    const double survival = std::min(1.0, throughput.max() / (kSafe * through_slits));
    if (!(random.uniform() < survival)) return E;
    throughput *= 1 / survival;

    const WayOn way = way_on(light_, p, n, square_of_way, random);
    if (!(way.factor > 0)) return E;
    throughput *= way.factor;
    if (way.by_slit) through_slits *= std::min(1.0, way.factor);
    const Ray ray{p, way.direction};
    const Hit hit = one_way(light_.problem.rays, patches, ray, random);
    ++rays;
    throughput *= hit.transmittance;
    if (hit.escaped()) {
      const Spectrum L = light_.sky(hit.direction(ray));
      if (L.is_black()) return E;
      const PathEnd end = ends.end_in_sky(p, n, way.direction, way.density, hit);
      return E + throughput * L * (std::numbers::pi * end.met / end.all(before));
    }
    if (!hit.patch.valid()) return E;
    const double cos_x = std::max(-dot(patches.normal[hit.patch], hit.direction(ray)), kGrazing),
                 cos_p = dot(n, way.direction);
    const Spectrum M = patches.M[hit.patch];
    if (!M.is_black()) {
      const PathEnd end = ends.end_on_patch(hit.patch, n, way.direction, way.density,
                                            light_.sampler.density(hit, p, n, way.direction, false));
      E += throughput * M * (end.met / end.all(before));
    }
    const auto on = patches.scatter(hit.patch, patches.scatters_through(hit.patch) ? random.uniform() : 0);
    throughput *= on.share;
    if (throughput.is_black()) return E;
    const Vec3 x = in_plane_of(patches, hit.patch, hit.position(ray));
    before = joints_before(
        path_part(way.density, cos_p, cos_x, square(x - p), ends.survival(hit.patch), !hit.reflected), before);
    n = on.normal;
    p = light_.problem.rays.off_surface(x, n);
    choice = {random.uniform(), random.uniform(), random.uniform()};
    if (!light_.openings.empty()) opening = {random.uniform(), random.uniform(), random.uniform()};
    square_of_way = {random.uniform(), random.uniform()};
  }
}

PathEstimator Bidirectional::estimator() const {
  return {light_.problem.patches.channels,
          [this](const Vec3& p, const Vec3& n, const PathStart& start, RandomStream& random, unsigned long long& rays,
                 const Monitor& monitor) { return trace(p, n, start, random, rays, monitor); }};
}

}  // namespace clerestory
