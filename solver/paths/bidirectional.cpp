#include "solver/paths/bidirectional.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "solver/lights/luminaire.h"
#include "solver/lights/near_planes.h"
#include "solver/lights/sun.h"
#include "solver/model/units.h"
#include "solver/paths/path_balance.h"
#include "solver/paths/path_place.h"
#include "solver/paths/way_on.h"
#include "solver/visibility/echoes.h"

namespace clerestory {
namespace {

/// A particle goes on from a surface with its albedo for the chance, and no more than this, so that their number has a
/// bound where surfaces absorb nothing.
constexpr double kMostSurvival = 0.95;

/// The last part of a path on its way to `at`, and what it was before.
struct EyePlace {
  PathPlace at;
  Spectrum throughput{1.0};  ///< of what arrives
  double survival = 1;       ///< chance with which a particle would go on
  double from_eye = 0;       ///< PathPart::from_eye
  double of_light = 0;       ///< PathPart::from_light over its density of directions
  bool can_join = false;
  double before_last = 0;
  bool is_receiver = true;

  /// joints_before(), of a light in direction d.
  double before(const Vec3& d) const {
    if (is_receiver) return 0;
    return joints_before({from_eye, survival * at.density_back(d) * of_light, can_join}, before_last);
  }
};

/// The same of a particle.
struct ParticlePlace {
  PathPlace at;
  Spectrum flux;  ///< that arrives [W]
  double survival;
  std::optional<PathEnd> end{};  ///< of the first place; but for PathEnd::met
  bool can_be_met = true;        ///< the light of that
  double from_light = 0;         ///< PathPart::from_light
  double of_eye = 0;             ///< PathPart::from_eye over its density of directions
  bool can_join = false;
  double beyond_last = 0;

  /// joints_beyond(), of a path from direction d.
  double beyond(const Vec3& d) const {
    if (end) return PathEnd{can_be_met ? at.density_back(d) : 0, end->shadow_ray, end->from_light}.beyond();
    return joints_beyond({at.density_back(d) * of_eye, from_light, can_join}, beyond_last);
  }
};

double square(const Vec3& a) { return dot(a, a); }

/// Both ends of a problem, for one path.
class BothEnds {
 public:
  BothEnds(const Illumination& light, const Emission& emission, const RayScene& scene,
           const Bidirectional::Images& images, unsigned long long& rays)
      : light_(light),
        emission_(emission),
        images_(images),
        problem_(light.problem),
        scene_(scene),
        patches_(light.problem.patches),
        rays_(rays) {}

  /// The places of a particle. pick, u: as of Emission::sample().
  std::vector<ParticlePlace> particle(double pick, const std::array<double, 4>& u, RandomStream& random) const;

  /// What arrives at a place of a path from the receiver and goes on to there.
  Spectrum by_shadow_ray(const EyePlace& z, const std::array<double, 3>& u) const;
  Spectrum through_opening(const EyePlace& z, const std::array<double, 3>& u) const;
  Spectrum joined(const EyePlace& z, const ParticlePlace& y) const;

  double survival(PatchId p, const PathPlace& at) const {
    const double albedo = patches_.albedo(p).max() + (at.lobe ? at.lobe->specular().max() : 0);
    return std::min(albedo, kMostSurvival);
  }
  double density_of_way(const PathPlace& at, const Vec3& d) const {
    return at.density(d, density_of_ways(light_, at.x, at.n, d));
  }

  /// The end of a path at z: the sky in direction d, met by `hit`, or a patch that glows.
  PathEnd end_in_sky(const PathPlace& z, const Vec3& d, double density_of_way, const Hit& hit) const {
    const Ray back = hit.reflected ? hit.leg : Ray{z.x, d};
    const double by_opening = hit.reflected || light_.openings.empty() ? 0 : light_.openings.preference(z.x, z.n, d);
    return {density_of_way, by_opening, emission_.density_of_sky(back.origin, -back.direction) * dot(z.n, d)};
  }
  PathEnd end_on_patch(PatchId q, const PathPlace& z, const Vec3& d, double density_of_way,
                       double by_shadow_ray) const {
    return {density_of_way, by_shadow_ray, emission_.density_of_patch(q) * dot(z.n, d) / std::numbers::pi};
  }

 private:
  struct FirstLeg {
    Ray sent, ray;  ///< from the light; the last part, that hit's is
    Hit hit;
    Spectrum flux{0.0};                    ///< that arrives [W]
    std::uint32_t light = Emitted::kNone;  ///< luminaire or sun that shines there, perhaps an image
    Spectrum passes{1.0};                  ///< of that, share that panes and mirrors leave
    double r2 = 0;                         ///< squared distance of a luminaire, or its image
  };
  FirstLeg first_leg(const Emitted& e, const std::array<double, 4>& u, RandomStream& random) const;
  FirstLeg delta_leg(std::uint32_t light, const Ray& sent, const Spectrum& flux, RandomStream& random) const;
  PathEnd end_of_particle(const Emitted& e, const FirstLeg& first, const PathArrival& at) const;
  /// Of a sun's particle on its way to p, per area at right angles to it: that of the sun of this number, or of one
  /// that it shows; d: to it.
  double density_of_sun(std::uint32_t number, Vec3 p, Vec3 d) const {
    const auto luminaires = static_cast<std::uint32_t>(problem_.lights.luminaires.size());
    const PlacedSun& sun = problem_.lights.suns[number - luminaires];
    for (std::size_t k = sun.way.count; k-- > 0;) {
      const MirrorPlane& plane = scene_.mirrors()[sun.way.plane[k]];
      p = plane.image_of(p), d = plane.image_of_direction(d);
    }
    const std::uint32_t source = sun.is_image() ? luminaires + sun.shows : number;
    return emission_.density_of_sun(source, p, -d) / density_in_disc(problem_.lights.suns[source - luminaires], d);
  }
  bool is_luminaire(std::uint32_t light) const { return light < problem_.lights.luminaires.size(); }

  const Illumination& light_;
  const Emission& emission_;
  const Bidirectional::Images& images_;
  const Problem& problem_;
  const RayScene& scene_;  ///< without gloss
  const PatchSet& patches_;
  unsigned long long& rays_;
};

/// On along the ray, or where a pane or mirror turns it, as one_way() does, but that only ways with an image of the
/// light count, and it says which.
BothEnds::FirstLeg BothEnds::delta_leg(std::uint32_t light, const Ray& sent, const Spectrum& flux,
                                       RandomStream& random) const {
  FirstLeg first{sent, sent, scene_.first_hit(patches_, sent), flux, light};
  ++rays_;
  if (!images_.empty()) {
    MirrorWay way;
    for (;;) {
      const bool ends_on_mirror = first.hit.reflected;
      const std::vector<Turn> turns = scene_.turns(first.ray);
      double on = ends_on_mirror ? 0 : luminous_mean(first.hit.transmittance), all = on;
      for (const Turn& turn : turns) all += luminous_mean(turn.share);
      if (!(all > 0)) return {};
      double pick = random.uniform() * all - on;
      if (pick < 0 || turns.empty()) {
        first.flux *= all / on;
        break;
      }
      const Turn* next = &turns.back();
      for (const Turn& turn : turns) {
        if (pick >= 0 && pick < luminous_mean(turn.share)) next = &turn;
        pick -= luminous_mean(turn.share);
      }
      if (next->plane == kNoPlane || way.count == MirrorWay::kMost) return {};
      way = way.over(next->plane);
      first.flux *= next->share * (all / luminous_mean(next->share));
      first.passes *= next->share;
      first.ray = next->ray;
      first.hit = scene_.first_hit(patches_, first.ray);
      ++rays_;
    }
    if (!way.empty()) {
      const auto image = images_.find({light, way});
      if (image == images_.end()) return {};
      first.light = image->second;
    }
  }
  if (!first.hit.patch.valid() || first.hit.reflected) return {};
  first.flux *= first.hit.transmittance;
  first.passes *= first.hit.transmittance;
  return first;
}

/// Where a particle first falls. Luminaires shine from all over their opening near by and from its middle farther away:
/// it is sent from both, and counts where that is where it comes from.
BothEnds::FirstLeg BothEnds::first_leg(const Emitted& e, const std::array<double, 4>& u, RandomStream& random) const {
  if (e.light == Emitted::kNone) {
    FirstLeg first{e.ray, e.ray, one_way(scene_, patches_, e.ray, random)};
    ++rays_;
    if (first.hit.patch.valid()) first.flux = e.flux * first.hit.transmittance;
    return first;
  }
  if (!is_luminaire(e.light)) return delta_leg(e.light, e.ray, e.flux, random);
  const PlacedLuminaire& luminaire = problem_.lights.luminaires[e.light];
  const Vec3& d = e.ray.direction;
  const auto from = [&](const Vec3& q) {
    FirstLeg first = delta_leg(e.light, {ray_start(luminaire, q, d), d}, e.flux, random);
    if (first.flux.is_black()) return first;
    const Luminaire& shown = problem_.lights.luminaires[first.light];
    const Vec3 x = first.hit.position(first.ray), from_there = light_point(shown, x, u[0], u[1]);
    if ((q == luminaire.position) != (from_there == shown.position)) return FirstLeg{};
    // At points luminaires do not dazzle: less arrives very near them.
    first.r2 = square(x - from_there);
    const double whole = luminous_mean(intensity(luminaire, d)) / first.r2;
    const double arrives = luminous_mean(open_irradiance(luminaire, q, q + d * std::sqrt(first.r2), -d));
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

/// But for PathEnd::met.
PathEnd BothEnds::end_of_particle(const Emitted& e, const FirstLeg& first, const PathArrival& at) const {
  if (e.patch.valid()) {
    const bool can_choose = !first.hit.reflected && light_.sampler.is_bright(e.patch);
    const double to_patch =
        can_choose ? light_.sampler.density(e.patch, light_.sampler.receiver(at.x, at.n), first.hit.distance,
                                            dot(patches_.normal[e.patch], first.sent.direction), false)
                   : 0;
    return {0, to_patch, e.density_place * at.cosine / std::numbers::pi};
  }
  if (e.is_sky()) {
    const double by_opening =
        first.hit.reflected || light_.openings.empty() ? 0 : light_.openings.preference(at.x, at.n, at.back);
    return {0, by_opening, e.density_place * e.density_direction * at.cosine};
  }
  const double by_shadow_ray = light_.sampler.probability(first.light, at.x, at.n);
  // Of several ways, each is taken by what it leaves of the light.
  const double chance = first.light == e.light ? 1 : luminous_mean(first.passes);
  if (!is_luminaire(e.light)) return {0, by_shadow_ray, e.density_place * at.cosine * chance};
  return {0, by_shadow_ray, e.density_place * e.density_direction * at.cosine / first.r2 * chance};
}

std::vector<ParticlePlace> BothEnds::particle(double pick, const std::array<double, 4>& u, RandomStream& random) const {
  std::vector<ParticlePlace> places;
  if (emission_.empty()) return places;
  const Emitted e = emission_.sample(pick, u);
  if (e.flux.is_black()) return places;
  const FirstLeg first = first_leg(e, u, random);
  Spectrum flux = first.flux;
  if (flux.is_black()) return places;
  Hit hit = first.hit;
  Ray ray = first.ray;
  double way = 0;  // density of the last one [1/sr]
  for (;;) {
    const PathArrival arrival = arrival_of(problem_, hit, ray);
    ParticlePlace y{place_of(problem_, hit, arrival, random), flux, 0};
    y.survival = survival(hit.patch, y.at);
    y.at.diffusely_back = density_of_ways(light_, arrival.x, arrival.n, arrival.back);
    if (places.empty()) {
      y.end = end_of_particle(e, first, arrival);
      y.can_be_met = e.light == Emitted::kNone;
    } else {
      // From the receiver this part is gone the other way.
      const ParticlePlace& last = places.back();
      const double d2 = square(arrival.on - last.at.x);
      y.from_light = last.survival * way * arrival.cosine / d2;
      y.of_eye = dot(last.at.n, ray.direction) / d2;
      y.can_join = !hit.reflected;
      y.beyond_last = last.beyond(ray.direction);
    }
    if (y.at.albedo().is_black()) return places;
    places.push_back(y);
    if (!(random.uniform() < y.survival)) return places;
    const PathWay on = way_from_light(y.at, random);
    flux *= on.factor / y.survival;
    if (flux.is_black()) return places;
    way = on.density;
    ray = {y.at.x, on.direction};
    hit = one_way(scene_, patches_, ray, random);
    ++rays_;
    if (!hit.patch.valid()) return places;
    flux *= hit.transmittance;
  }
}

Spectrum BothEnds::by_shadow_ray(const EyePlace& z, const std::array<double, 3>& u) const {
  const Vec3 &p = z.at.x, &n = z.at.n;
  const LightSample s = light_.sampler.sample(light_.sampler.receiver(p, n), u[0], u[1], u[2], false);
  if (s.irradiance.is_black()) return s.irradiance;
  const Vec3 to = s.end - p, d = normalized(to);
  const Spectrum reflected = s.irradiance * z.at.reflects(d);
  if (reflected.is_black()) return reflected;
  ++rays_;
  const Spectrum passes = scene_.transmittance_by_mirrors(p, s.end, s.way);
  if (passes.is_black()) return passes;
  const double before = z.before(d), cosine = dot(n, d);
  PathEnd end{0, s.probability};
  if (s.patch.valid()) {
    end = end_on_patch(s.patch, z.at, d, density_of_way(z.at, d), s.density);
  } else if (before > 0) {
    if (is_luminaire(s.light)) {
      const PlacedLuminaire& luminaire = problem_.lights.luminaires[s.light];
      const std::uint32_t source = luminaire.is_image() ? luminaire.shows : s.light;
      end.from_light = emission_.probability_of_luminaire(source) * emission_.density_of_direction(s.light, -d) *
                       cosine / square(to);
    } else {
      end.from_light = density_of_sun(s.light, p, d) * cosine;
    }
    if (!s.way.empty()) end.from_light *= luminous_mean(passes);
  }
  return reflected * passes * (end.shadow_ray / end.all(before));
}

Spectrum BothEnds::through_opening(const EyePlace& z, const std::array<double, 3>& u) const {
  const Vec3 &p = z.at.x, &n = z.at.n;
  const OpeningSampler::Sample s = light_.openings.sample(p, n, u[0], u[1], u[2]);
  const double cosine = dot(n, s.direction);
  if (!(s.per_choice > 0) || !(cosine > 0)) return Spectrum(0.0);
  rays_ += kCostOfOpening;
  const Spectrum passes = scene_.transmittance(p, p + s.direction * (4 * scene_.diameter()));
  if (passes.is_black()) return passes;
  const PathEnd end{density_of_way(z.at, s.direction),
                    s.preference + light_.openings.preference(p, n, s.direction, s.opening),
                    emission_.density_of_sky(p, -s.direction) * cosine};
  return light_.sky(s.direction) * z.at.reflects(s.direction) * passes *
         (cosine * s.per_choice * s.preference / end.all(z.before(s.direction)));
}

Spectrum BothEnds::joined(const EyePlace& z, const ParticlePlace& y) const {
  const Vec3 to = y.at.x - z.at.x;
  const double d2 = square(to), along_z = dot(z.at.n, to), along_y = -dot(y.at.n, to);
  if (!(along_z > 0 && along_y > 0)) return Spectrum(0.0);
  const double r = std::sqrt(d2), cos_z = along_z / r, cos_y = along_y / r;
  const Vec3 d = to / r;
  const Spectrum share = y.flux * y.at.reflects(-d) * z.at.reflects(d);
  if (share.is_black()) return share;
  const PathPart part{density_of_way(z.at, d) * cos_y / d2,
                      y.survival * y.at.density(-d, cos_y / std::numbers::pi) * cos_z / d2, true};
  ++rays_;
  return share * scene_.transmittance(z.at.x, y.at.x) *
         (cos_z * cos_y / (std::numbers::pi * d2) * weight_of_joint(part, z.before(d), y.beyond(-d)));
}

}  // namespace

Bidirectional::Bidirectional(const Illumination& light)
    : light_(light), scene_(light.problem.rays.without_gloss()), emission_(light) {
  const Lights& lights = light.problem.lights;
  const auto luminaires = static_cast<std::uint32_t>(lights.luminaires.size());
  for (std::uint32_t k = 0; k < luminaires; ++k)
    if (const PlacedLuminaire& luminaire = lights.luminaires[k]; luminaire.is_image())
      images_[{luminaire.shows, luminaire.way}] = k;
  for (std::uint32_t k = 0; k < lights.suns.size(); ++k)
    if (const PlacedSun& sun = lights.suns[k]; sun.is_image())
      images_[{luminaires + sun.shows, sun.way}] = luminaires + k;
}

Spectrum Bidirectional::trace(Vec3 p, Vec3 n, const PathStart& start, RandomStream& random, unsigned long long& rays,
                              const Monitor& monitor) const {
  const Problem& problem = light_.problem;
  const BothEnds ends(light_, emission_, scene_, images_, rays);
  const std::vector<ParticlePlace> particle =
      ends.particle(sobol4(start.number, start.key + 4)[0], sobol4(start.number, start.key + 3), random);

  Spectrum E(0.0);
  EyePlace z;
  z.at.x = p, z.at.n = n;
  double through_slits = 1;  // what they leave; no reason to end a path that was sent there
  std::array<double, 2> square_of_way = start.direction;
  std::array<double, 3> choice = start.light, opening = start.opening;
  constexpr unsigned kBouncesBetween = 1 << 10;
  for (unsigned bounce = 1;; ++bounce) {
    if (bounce % kBouncesBetween == 0 && monitor.should_stop()) return E;
    if (!light_.sampler.empty()) E += z.throughput * ends.by_shadow_ray(z, choice);
    if (!light_.openings.empty()) E += z.throughput * ends.through_opening(z, opening);
    for (const ParticlePlace& y : particle) E += z.throughput * ends.joined(z, y);
    const double survival = std::min(1.0, (z.throughput * z.at.albedo()).max() / (kSafe * through_slits));
    if (!(random.uniform() < survival)) return E;

    const PathWay way = way_from_eye(light_, z.at, square_of_way, random);
    Spectrum throughput = z.throughput * way.factor / survival;
    if (throughput.is_black()) return E;
    through_slits *= way.by_slits;
    const Vec3& d = way.direction;
    const Ray ray{z.at.x, d};
    const Hit hit = one_way(scene_, problem.patches, ray, random);
    ++rays;
    throughput *= hit.transmittance;
    if (hit.escaped()) {
      const Spectrum L = light_.sky(hit.direction(ray));
      if (L.is_black()) return E;
      const PathEnd end = ends.end_in_sky(z.at, d, way.density, hit);
      return E + throughput * L * (std::numbers::pi * end.met / end.all(z.before(d)));
    }
    if (!hit.patch.valid()) return E;
    if (const Spectrum M = problem.patches.M[hit.patch]; !M.is_black()) {
      const PathEnd end =
          ends.end_on_patch(hit.patch, z.at, d, way.density, light_.sampler.density(hit, z.at.x, z.at.n, d, false));
      E += throughput * M * (end.met / end.all(z.before(d)));
    }
    const PathArrival arrival = arrival_of(problem, hit, ray);
    EyePlace next{place_of(problem, hit, arrival, random), throughput};
    next.at.diffusely_back = arrival.cosine / std::numbers::pi;
    next.survival = ends.survival(hit.patch, next.at);
    const double d2 = square(arrival.on - z.at.x);
    next.from_eye = way.density * arrival.cosine / d2;
    next.of_light = dot(z.at.n, d) / d2;
    next.can_join = !hit.reflected;
    next.before_last = z.before(d);
    next.is_receiver = false;
    if ((next.throughput * next.at.albedo()).is_black()) return E;
    z = next;
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
