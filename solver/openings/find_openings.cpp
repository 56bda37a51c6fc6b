#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "solver/geometry/polygon.h"
#include "solver/lights/luminaire.h"
#include "solver/lights/near_planes.h"
#include "solver/lights/sky.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/openings/find_gaps.h"
#include "solver/openings/openings.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

// By judgement: what is taken for an opening or not biases nothing, it only says where to look.
constexpr int kFewRays = 16, kRays = 128;          ///< to a side, to sift and to judge
constexpr int kManyRays = 256;                     ///< where it is so dark that those found nothing
constexpr double kSeesSky = 0.1;                   ///< share of the rays out that meet sky
constexpr double kIndoors = 0.2;                   ///< most of the rays in that do
constexpr double kWideOpen = 0.5;                  ///< and those that do so mostly are preferred
constexpr double kDarker = 0.1;                    ///< of what one side of a slit sees: the other sees less
constexpr double kDarkerByFew = 0.5;               ///< the same, to sift
constexpr int kSeldom = 32, kSeldomByFew = 8;      ///< or this many times fewer ways find light there
constexpr int kWalks = 8;                          ///< for each of those rays, to judge how bright a side is
constexpr std::size_t kFewLuminaires = 16;         ///< that are asked for it
constexpr std::size_t kMostSlits = 200;            ///< that are judged by walks, the largest
constexpr std::size_t kMostDarkSlits = 100;        ///< of those kept through which no sky is seen
constexpr double kNew = 0.1;                       ///< of the rays out, those that see sky which no other opening shows
constexpr std::size_t kMostCorners = 256;          ///< of an outline; a window has few
constexpr std::size_t kMostCandidates = 5000;      ///< good ones, the best
constexpr std::size_t kMostTriangles = 2'000'000;  ///< of a model that is searched, for the time it takes
constexpr std::size_t kMostOpenings = 500;         ///< every point asks each of them what it may give
constexpr int kRaysOfReach = 512;                  ///< through an opening, to see where it is in view
constexpr double kBeyondReach = 0.02;              ///< of the diagonal of what they meet

struct SkySeen {
  double share = 0, radiance = 0;  ///< of the rays that escape through air or glass; mean of what they see
};

class Judge {
 public:
  Judge(const PatchSet& patches, const RayScene& rays, const Lights& lights, const SkyRadiance& sky)
      : patches_(patches), rays_(rays), lights_(lights), sky_(sky) {}

  SkySeen sky_from(const LightArea& o, const Vec3& side, int count, std::uint64_t key) const {
    SkySeen seen;
    for (int k = 0; k < count; ++k) {
      const Ray ray = ray_through(o, side, key, static_cast<std::uint32_t>(k), rays_.lift());
      const Hit hit = rays_.first_hit(patches_, ray);
      if (!hit.escaped() || hit.transmittance.is_black()) continue;
      seen.share += 1.0 / count;
      seen.radiance += luminous_mean(sky_(hit.direction(ray)) * hit.transmittance) / count;
    }
    if (seen.share > 0) seen.radiance /= seen.share;
    return seen;
  }

  /// Turns the normal into the darker room. returns whether it is much darker than the other one.
  bool judge_slit(LightArea& o, std::uint64_t key) const {
    int dark = 0;  // the first so many rays, to either side, found nothing
    for (const int count : {kFewRays, kRays, kManyRays}) {
      Brightness front = brightness_from(o, o.normal, dark, count, key),
                 back = brightness_from(o, -o.normal, dark, count, key + 2);
      if (front.lit == 0 && back.lit == 0) dark = count;
      if (is_darker(back, front)) {
        turn(o);
        std::swap(front, back);
      }
      o.brightness = back.mean;
      if (front.mean > kDarkerByFew * back.mean && front.lit * kSeldomByFew > back.lit) return false;
      if (count > kFewRays && back.lit > 0) return front.mean <= kDarker * back.mean || front.lit * kSeldom <= back.lit;
    }
    return false;  // dark on both sides
  }

  /// Turns the normal into the room. returns the share of rays out that see sky; 0: no opening between a room and it.
  double judge(LightArea& o, std::uint64_t key) const {
    double share = 0;
    for (const int count : {kFewRays, kRays}) {
      SkySeen front = sky_from(o, o.normal, count, key), back = sky_from(o, -o.normal, count, key + 2);
      if (front.share > back.share) {
        turn(o);
        std::swap(front, back);
      }
      if (!(back.share > kSeesSky) || !(front.share < kIndoors)) return 0;
      o.brightness = back.radiance;
      share = o.brightness > 0 ? back.share : 0;
    }
    return share;
  }

  /// Whether sky is seen through it that the others do not show; through a slit, anything.
  bool shows_more(const LightArea& o, std::span<const LightArea> others, std::uint64_t key) const {
    int more = 0;
    for (int k = 0; k < kRays; ++k) {
      // From a little inside: an opening in the same plane is passed as well.
      const Ray ray = ray_through(o, -o.normal, key, static_cast<std::uint32_t>(k), rays_.lift());
      if (!is_slit(o) && !rays_.first_hit(patches_, ray).escaped()) continue;
      const Vec3 inside = ray.origin - ray.direction * (1e-5 * rays_.diameter());
      more += std::ranges::none_of(others,
                                   [&](const LightArea& other) { return way_out(other, inside, ray.direction) >= 0; });
    }
    return more > kNew * kRays;
  }

 private:
  static void turn(LightArea& o) {
    o.normal = -o.normal;
    for (auto& t : o.triangles) std::swap(t[1], t[2]);
    std::reverse(o.corners.begin(), o.corners.end());
  }

  /// What is seen on one side of a slit, by light that has met four surfaces at most and did not come through the slit
  /// itself. dark: of the count, rays that are known to find nothing.
  struct Brightness {
    double mean = 0;  ///< radiance
    int lit = 0;      ///< ways that found any light
  };
  Brightness brightness_from(const LightArea& o, const Vec3& side, int dark, int count, std::uint64_t key) const {
    Brightness found;
    for (auto k = static_cast<std::uint32_t>(dark * kWalks); k < static_cast<std::uint32_t>(count * kWalks); ++k) {
      const double L = walk(o, ray_through(o, side, key, k, rays_.lift()), stream_key(key, k));
      found.mean += L / (count * kWalks);
      found.lit += L > 0;
    }
    return found;
  }
  /// A room may look bright by the one way in a thousand that finds the sky through another slit.
  static bool is_darker(const Brightness& a, const Brightness& b) {
    if (a.lit * kSeldomByFew <= b.lit || b.lit * kSeldomByFew <= a.lit) return a.lit < b.lit;
    return a.mean < b.mean;
  }
  /// Radiance that comes back along a ray, luminous mean, by one way over surfaces.
  double walk(const LightArea& o, Ray ray, std::uint64_t key) const {
    constexpr std::uint32_t kMostBounces = 4;
    Spectrum L(0.0), share(1.0);
    for (std::uint32_t bounce = 0;; ++bounce) {
      const Hit hit = rays_.first_hit(patches_, ray);
      if (bounce > 0 && is_passed(o, ray.origin, ray.direction, hit.first)) return luminous_mean(L);
      share *= hit.transmittance;
      if (hit.escaped()) return luminous_mean(L + share * sky_(hit.direction(ray)));
      if (!hit.patch.valid() || bounce == kMostBounces) return luminous_mean(L);
      const Vec3 n = patches_.normal[hit.patch], p = rays_.off_surface(hit.position(ray), n);
      L += share * (patches_.M[hit.patch] + patches_.rho[hit.patch] * delta_light(p, n)) * (1 / std::numbers::pi);
      share *= patches_.rho[hit.patch];
      const auto u = sobol4(bounce, key);
      ray = {p, cosine_direction(Frame(n), u[0], u[1])};
    }
  }
  Spectrum delta_light(const Vec3& p, const Vec3& n) const {
    Spectrum E(0.0);
    for (const PlacedSun& sun : lights_.suns) {
      const double cosine = dot(sun.direction, n);
      if (!sun.is_image() && cosine > 0 && rays_.first_hit(patches_, {p, sun.direction}).escaped())
        E += sun.normal_irradiance * cosine;
    }
    const std::size_t luminaires = lights_.luminaires.size(), step = 1 + luminaires / kFewLuminaires;
    for (std::size_t k = 0; k < luminaires; k += step) {
      const PlacedLuminaire& luminaire = lights_.luminaires[k];
      if (luminaire.is_image()) continue;
      const ShadowSegment way = shadow_segment(luminaire, luminaire.position, p);
      if (way.is_free || rays_.visible(way.from, way.to))
        E += open_irradiance(luminaire, p, n) * static_cast<double>(step);
    }
    return E;
  }

  const PatchSet& patches_;
  const RayScene& rays_;
  const Lights& lights_;
  const SkyRadiance& sky_;
};

/// No opening when it has no area.
LightArea opening_across(const Gap& gap) {
  LightArea o;
  if (gap.corners.size() > kMostCorners) return o;
  const Vec3 area = vector_area(gap.corners);
  o.area = length(area);
  if (!(o.area > 0)) return o;
  o.normal = area / o.area;
  o.corners = gap.corners;
  o.triangles = triangulate(gap.corners);
  const BoundingSphere sphere = bounding_sphere(gap.corners);
  o.centre = sphere.centre, o.radius = sphere.radius;
  return o;
}

/// Around all that rays meet which come in by an opening, and itself.
Box reach_of(const LightArea& o, const RayScene& rays, std::uint64_t key) {
  Box reach = Box::around(o.corners);
  for (std::uint32_t k = 0; k < kRaysOfReach; ++k) {
    const Ray ray = ray_through(o, o.normal, key, k, rays.lift());
    if (const double way = rays.first_surface(ray); std::isfinite(way)) reach.add(ray.origin + ray.direction * way);
  }
  return reach.grown(kBeyondReach * length(reach.upper - reach.lower));
}

}  // namespace

std::vector<LightArea> find_openings(const PatchSet& patches, const RayScene& rays, const Lights& lights) {
  if (patches.triangle_count() > kMostTriangles) return {};
  const auto is_black = [](double M) { return M == 0; };
  if (lights.empty() && std::ranges::all_of(patches.M.value, is_black)) return {};
  const SkyRadiance sky(lights);
  const Judge judge(patches, rays, lights, sky);
  struct Candidate {
    LightArea opening;
    bool is_hole;
    double sky = 0;             ///< share of the rays out that see it
    bool is_dark_slit = false;  ///< no sky, and much brighter surfaces on one side
  };
  std::vector<Candidate> candidates;
  for (const Gap& gap : find_gaps(patches, rays)) {
    LightArea o = opening_across(gap);
    if (o.area > 0 && !o.triangles.empty() && (lights.sky || is_slit(o)))
      candidates.push_back({std::move(o), gap.is_hole});
  }
  std::vector<double> slits;
  for (const Candidate& c : candidates)
    if (is_slit(c.opening)) slits.push_back(c.opening.area);
  double smallest_slit = 0;
  if (slits.size() > kMostSlits) {
    std::nth_element(slits.begin(), slits.begin() + kMostSlits, slits.end(), std::greater<>());
    smallest_slit = slits[kMostSlits];
  }
  parallel_for(candidates.size(), 8, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      Candidate& c = candidates[k];
      const std::uint64_t key = stream_key(kGapRays, k);
      if (lights.sky) c.sky = judge.judge(c.opening, key);
      c.is_dark_slit =
          !(c.sky > 0) && c.opening.area > smallest_slit && is_slit(c.opening) && judge.judge_slit(c.opening, key);
    }
  });
  std::erase_if(candidates, [](const Candidate& c) { return !(c.sky > 0) && !c.is_dark_slit; });
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    if (a.is_dark_slit != b.is_dark_slit) return b.is_dark_slit;
    if (a.is_hole != b.is_hole) return a.is_hole;
    if ((a.sky > kWideOpen) != (b.sky > kWideOpen)) return a.sky > b.sky;
    return a.opening.area > b.opening.area;
  });
  if (candidates.size() > kMostCandidates) candidates.erase(candidates.begin() + kMostCandidates, candidates.end());
  std::vector<LightArea> openings;
  std::size_t dark_slits = 0;
  for (std::size_t k = 0; k < candidates.size() && openings.size() < kMostOpenings; ++k) {
    if (candidates[k].is_dark_slit && dark_slits == kMostDarkSlits) break;
    if (!judge.shows_more(candidates[k].opening, openings, stream_key(kGapsSifted, k))) continue;
    dark_slits += candidates[k].is_dark_slit;
    candidates[k].opening.sees_sky = !candidates[k].is_dark_slit;
    openings.push_back(std::move(candidates[k].opening));
  }
  // The inner face of a thick wall may have come before the outer one.
  for (std::size_t k = openings.size(); k > 0; --k) {
    LightArea opening = std::move(openings[k - 1]);
    openings.erase(openings.begin() + static_cast<std::ptrdiff_t>(k - 1));
    if (judge.shows_more(opening, openings, stream_key(kGapsSiftedAgain, k)))
      openings.insert(openings.begin() + static_cast<std::ptrdiff_t>(k - 1), std::move(opening));
  }
  parallel_for(openings.size(), 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) openings[k].reach = reach_of(openings[k], rays, stream_key(kReach, k));
  });
  return openings;
}

}  // namespace clerestory
