#include "solver/illumination/find_images.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "solver/geometry/triangle.h"
#include "solver/lights/beam.h"
#include "solver/lights/luminaire.h"
#include "solver/lights/near_planes.h"
#include "solver/lights/sun.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

// By judgement, as shares of a light's flux: what a way over one pane must turn to be worth an image, and what one over
// several mirrors or panes must.
constexpr double kWorthAPane = 2e-4, kWorthMore = 1e-3;
constexpr std::size_t kMostImages = 64;      // of a light
constexpr std::size_t kMostOfAll = 1 << 12;  // of all luminaires
constexpr std::size_t kRaysOfAll = 1 << 16, kFewestRays = 256, kMostRays = 1 << 14;

/// What takes a way.
struct Taken {
  double comes = 0, turned = 0;  ///< flux before the last plane of it, and after
};
using Ways = std::map<MirrorWay, Taken>;

/// What is left of the light on a way, of which the walk noted every part.
double share_left(const Ways& ways, MirrorWay way) {
  double share = 1;
  for (; way.count > 0; way = way.without_last()) {
    const Taken& taken = ways.at(way);
    share *= taken.turned / taken.comes;
  }
  return share;
}

/// Light of some flux on its way over mirrors and panes.
class Walk {
 public:
  Walk(const RayScene& rays, Ways& ways) : rays_(rays), ways_(ways) {}

  /// Follows a ray, or from a turn on: all that turns it takes its share, and one of these ways is followed further.
  void follow(Ray ray, double flux, MirrorWay way, RandomStream& random) {
    const double least = 1e-3 * flux;
    while (flux > least) {
      const std::vector<Turn> turns = rays_.turns(ray);
      double all = 0;
      for (const Turn& turn : turns) all += luminous_mean(turn.share);
      if (!(all > 0)) return;
      double pick = random.uniform() * all;
      const Turn* next = &turns.back();
      for (const Turn& turn : turns) {
        note(turn, flux, way);
        if (pick >= 0 && pick < luminous_mean(turn.share)) next = &turn;
        pick -= luminous_mean(turn.share);
      }
      if (next->plane == kNoPlane || way.count == MirrorWay::kMost) return;
      flux *= all;
      way = way.over(next->plane);
      ray = next->ray;
    }
  }

  void note(const Turn& turn, double flux, const MirrorWay& way) {
    const double turned = flux * luminous_mean(turn.share);
    if (turn.plane == kNoPlane && turn.is_mirror) return;  // particles go on from there: caustic_legs.h
    if (turn.plane == kNoPlane || way.count == MirrorWay::kMost) {
      lost += turned;
      return;
    }
    Taken& taken = ways_[way.over(turn.plane)];
    taken.comes += flux, taken.turned += turned;
  }

  double lost = 0;  ///< on ways that have no image

 private:
  const RayScene& rays_;
  Ways& ways_;
};

/// The ways that a light takes, and which of them are worth an image.
struct Images {
  struct Image {
    MirrorWay way;
    double turned, share;
  };
  std::vector<Image> images;
  double lost = 0;

  /// flux: what the least shares are of.
  Images(const Ways& ways, double lost_on_the_way, double flux, const std::vector<MirrorPlane>& planes)
      : lost(lost_on_the_way) {
    std::vector<bool> has_image(planes.size());
    for (const auto& [way, taken] : ways) {
      const bool over_one = way.count == 1, by_mirror = over_one && !planes[way.plane[0]].is_glass;
      if (by_mirror || taken.turned > (over_one ? kWorthAPane : kWorthMore) * flux) {
        images.push_back({way, taken.turned, share_left(ways, way)});
        if (by_mirror) has_image[way.plane[0]] = true;
      } else {
        lost += taken.turned;
      }
    }
    std::ranges::stable_sort(images, std::greater<>(), &Image::turned);
    for (; images.size() > kMostImages; images.pop_back()) lost += images.back().turned;
    // Few rays may have missed a small mirror.
    for (std::uint32_t m = 0; m < planes.size(); ++m)
      if (!planes[m].is_glass && !has_image[m]) images.push_back({MirrorWay{}.over(m), 0, 0.5});
  }
};

PlacedLuminaire image_of(PlacedLuminaire luminaire, const Images::Image& image,
                         const std::vector<MirrorPlane>& planes) {
  luminaire.way = image.way, luminaire.share = image.share;
  for (std::size_t k = 0; k < image.way.count; ++k) {
    const MirrorPlane& mirror = planes[image.way.plane[k]];
    static_cast<Luminaire&>(luminaire) = image_of(static_cast<const Luminaire&>(luminaire), mirror);
    for (NearPlane& plane : luminaire.near_planes) {
      const Vec3 in_plane = mirror.image_of(plane.normal * plane.offset);
      plane.normal = mirror.image_of_direction(plane.normal);
      plane.offset = dot(plane.normal, in_plane);
    }
  }
  return luminaire;
}

Images images_of(const PlacedLuminaire& luminaire, const RayScene& rays, std::size_t ray_count, std::uint64_t key) {
  const Beam beam = beam_of(luminaire);
  Ways ways;
  Walk walk(rays, ways);
  double sent = 0;
  for (std::size_t k = 0; k < ray_count; ++k) {
    const auto u = sobol4(static_cast<std::uint32_t>(k), key);
    const Vec3 d = direction_in(beam, u[0], u[1]);
    const double I = luminous_mean(intensity(luminaire, d));
    if (!(I > 0)) continue;
    sent += I;
    RandomStream random(key, k);
    walk.follow({ray_start(luminaire, light_point(luminaire, luminaire.position, u[2], u[3]), d), d}, I, {}, random);
  }
  Images found(ways, walk.lost, sent, rays.mirrors());
  const double scale = sent > 0 ? luminous_mean(power(luminaire)) / sent : 0;
  for (Images::Image& image : found.images) image.turned *= scale;
  found.lost *= scale;
  return found;
}

void add_luminaires(Lights& lights, const RayScene& rays, double& flux, double& lost) {
  const std::size_t count = lights.luminaires.size();
  if (count == 0) return;
  const std::size_t rays_each = std::clamp(kRaysOfAll / count, kFewestRays, kMostRays);
  std::vector<Images> found(count, Images({}, 0, 0, {}));
  parallel_for(count, 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k)
      found[k] = images_of(lights.luminaires[k], rays, rays_each, stream_key(kWaysOfLuminaire, k));
  });
  std::vector<std::pair<double, std::pair<std::size_t, std::size_t>>> all;
  for (std::size_t k = 0; k < count; ++k) {
    flux += luminous_mean(power(lights.luminaires[k]));
    lost += found[k].lost;
    for (std::size_t i = 0; i < found[k].images.size(); ++i) all.push_back({-found[k].images[i].turned, {k, i}});
  }
  std::ranges::sort(all);
  const std::size_t kept = std::min(all.size(), std::max(kMostOfAll, 2 * count));
  for (const auto& [turned, image] : std::span(all).subspan(kept)) lost -= turned;
  all.resize(kept);
  std::ranges::sort(all, {}, [](const auto& image) { return image.second; });
  for (const auto& [turned, image] : all) {
    lights.luminaires.push_back(
        image_of(lights.luminaires[image.first], found[image.first].images[image.second], rays.mirrors()));
    lights.luminaires.back().shows = static_cast<std::uint32_t>(image.first);
  }
}

/// Triangles of one plane, with the running sum of their areas.
struct Turning {
  std::vector<TriangleId> triangles;
  std::vector<double> area_up_to;
  double area() const { return area_up_to.empty() ? 0 : area_up_to.back(); }
};

/// By number of the plane; last what lies in planes without a number.
std::vector<Turning> what_turns(const PatchSet& patches, const RayScene& rays) {
  std::vector<Turning> planes(rays.mirrors().size() + 1);
  for (std::size_t t = 0; t < patches.triangle_count(); ++t) {
    const Material& material = patches.front_material(TriangleId{t});
    if (!material.turns_rays() && !material.lets_rays_pass()) continue;
    const auto& c = patches.corners[t];
    const Vec3& a = patches.vertices[c[0]];
    Turning& to = planes[std::min<std::size_t>(rays.plane_of(TriangleId{t}), rays.mirrors().size())];
    to.area_up_to.push_back(to.area() + length(cross(patches.vertices[c[1]] - a, patches.vertices[c[2]] - a)) / 2);
    to.triangles.push_back(TriangleId{t});
  }
  return planes;
}

/// From points all over what faces the sun.
Images images_of(const PlacedSun& sun, const PatchSet& patches, const RayScene& rays,
                 const std::vector<Turning>& planes, std::uint64_t key, double& comes_in) {
  Ways ways;
  Walk walk(rays, ways);
  const std::size_t numbered = rays.mirrors().size(), most = kMostRays / 4;
  for (std::size_t m = 0; m < planes.size(); ++m) {
    const Turning& turning = planes[m];
    if (!(turning.area() > 0)) continue;
    const bool has_number = m < numbered;
    const std::size_t count = has_number ? std::clamp(kMostRays / numbered, kFewestRays, most) : most;
    for (std::size_t k = 0; k < count; ++k) {
      const auto u = sobol4(static_cast<std::uint32_t>(k), stream_key(key, m));
      const auto at = std::ranges::upper_bound(turning.area_up_to, u[0] * turning.area());
      const auto& c = patches.corners[turning.triangles[std::min(
          static_cast<std::size_t>(at - turning.area_up_to.begin()), turning.triangles.size() - 1)]];
      const std::array triangle{patches.vertices[c[0]], patches.vertices[c[1]], patches.vertices[c[2]]};
      const Vec3 normal = has_number ? rays.mirrors()[m].normal
                                     : normalized(cross(triangle[1] - triangle[0], triangle[2] - triangle[0]));
      const double along = dot(normal, sun.direction);
      if (along == 0) continue;
      const double flux =
          luminous_mean(sun.normal_irradiance) * std::abs(along) * turning.area() / static_cast<double>(count);
      const Vec3 from = rays.off_surface(point_on_triangle(triangle, u[1], u[2]), along > 0 ? normal : -normal);
      const double passes = luminous_mean(rays.transmittance(from, from + sun.direction * (4 * rays.diameter())));
      if (!(passes > 0)) continue;
      comes_in += flux * passes;
      const std::vector<Turn> turns = rays.turns({from, -sun.direction});
      if (turns.empty() || turns.front().plane != (has_number ? m : kNoPlane)) continue;
      walk.note(turns.front(), flux * passes, {});
      if (!has_number) continue;  // it is lost
      RandomStream random(stream_key(key, m), k);
      walk.follow(turns.front().ray, flux * passes * luminous_mean(turns.front().share), MirrorWay{}.over(m), random);
    }
  }
  double turned = 0;
  for (const auto& [way, taken] : ways) turned += way.count == 1 ? taken.turned : 0;
  return {ways, walk.lost, turned, rays.mirrors()};
}

}  // namespace

void add_images(Lights& lights, const PatchSet& patches, const RayScene& rays) {
  if (rays.mirrors().empty()) return;
  double flux = 0, lost = 0;
  add_luminaires(lights, rays, flux, lost);
  const std::size_t suns = lights.suns.size();
  const std::vector<Turning> planes = suns > 0 ? what_turns(patches, rays) : std::vector<Turning>{};
  for (std::size_t s = 0; s < suns; ++s) {
    const Images found = images_of(lights.suns[s], patches, rays, planes, stream_key(kWaysOfSun, s), flux);
    lost += found.lost;
    for (const Images::Image& image : found.images) {
      PlacedSun shown = lights.suns[s];
      for (std::size_t k = 0; k < image.way.count; ++k)
        shown.direction = rays.mirrors()[image.way.plane[k]].image_of_direction(shown.direction);
      shown.way = image.way, shown.share = image.share, shown.shows = static_cast<std::uint32_t>(s);
      lights.suns.push_back(shown);
    }
  }
  lights.lost_in_mirrors = flux > 0 ? lost / flux : 0;
}

}  // namespace clerestory
