#include "solver/annual/sun_on_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "solver/illumination/image_beams.h"
#include "solver/lights/sun.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

/// What of the sun's image comes to a point over a way of mirrors and panes, over what a plane that faces it has: by
/// the pilots, and by more rays where these disagree.
double over_way(const RayScene& rays, const ReceivingPoint& at, const SunOfHour& sun, const MirrorWay& way) {
  const auto image_of = [&](Vec3 d) {
    for (std::size_t k = 0; k < way.count; ++k) d = rays.mirrors()[way.plane[k]].image_of_direction(d);
    return d;
  };
  if (!may_reach(rays, {Sun{image_of(sun.direction), Spectrum(1.0)}, way}, {&at.p, 1})) return 0;
  std::size_t lit = 0;
  const auto mean_of = [&](const std::vector<Vec3>& to_disc) {
    double sum = 0;
    for (const Vec3& to_sun : to_disc) {
      const Vec3 d = image_of(to_sun);
      const double cosine = dot(at.n, d);
      if (!(cosine > 0)) continue;
      const double passes = luminous_mean(rays.transmittance_by_mirrors(at.p, at.p + d * (4 * rays.diameter()), way));
      sum += cosine * passes;
      lit += passes > 0;
    }
    return sum / static_cast<double>(to_disc.size());
  };
  const double share = mean_of(sun.pilots);
  return lit == 0 || lit == sun.pilots.size() || sun.more.empty() ? share : mean_of(sun.more);
}

}  // namespace

SunOfHour::SunOfHour(const Vec3& to_sun, std::vector<MirrorWay> over, std::size_t rays, std::uint64_t key)
    : direction(to_sun), ways(std::move(over)) {
  const Vec3 aside = normalized(std::abs(to_sun.z) < 0.9999 ? cross({0, 0, 1}, to_sun) : Vec3{1, 0, 0});
  const Vec3 above = cross(to_sun, aside);
  const double radius = std::tan(kSunDiameterDeg / 2 * std::numbers::pi / 180);
  for (const Vec3& to_rim : {above, aside, above * -1.0, aside * -1.0})
    pilots.push_back(normalized(to_sun + to_rim * radius));
  for (std::size_t k = 0; k < rays; ++k) {
    const auto u = sobol4(static_cast<std::uint32_t>(k), key);
    more.push_back(direction_to_sun({to_sun, Spectrum(1.0)}, u[0], u[1]));
  }
}

void sun_on_points(const RayScene& rays, std::span<const ReceivingPoint> points, std::span<const SunOfHour> suns,
                   const std::vector<bool>& may_come, std::span<float> out) {
  struct Load {
    std::uint32_t point;
    float cosine;
  };
  std::vector<double> sum(points.size());
  std::vector<std::uint32_t> lit(points.size()), sent(points.size());
  auto shadows = shadow_rays<Load>(rays, [&](const Load& load, const Spectrum& passes) {
    sum[load.point] += double{load.cosine} * luminous_mean(passes);
    ++lit[load.point];
  });
  const double far = 4 * rays.diameter();
  const auto send = [&](std::size_t i, const Vec3& d) {
    const double cosine = dot(points[i].n, d);
    if (!(cosine > 0)) return;
    shadows.send(points[i].p, points[i].p + d * far, {static_cast<std::uint32_t>(i), static_cast<float>(cosine)});
    ++sent[i];
  };
  std::fill(out.begin(), out.end(), 0.0f);
  std::vector<std::size_t> looking;
  for (std::size_t h = 0; h < suns.size(); ++h) {
    looking.clear();
    for (std::size_t i = 0; i < points.size(); ++i)
      if (may_come.empty() || may_come[i * suns.size() + h]) looking.push_back(i), sum[i] = 0, lit[i] = sent[i] = 0;
    for (const Vec3& d : suns[h].pilots)
      for (const std::size_t i : looking) send(i, d);
    shadows.trace();
    for (const std::size_t i : looking) {
      double share = sum[i] / static_cast<double>(suns[h].pilots.size());
      if (!suns[h].more.empty() && lit[i] > 0 && lit[i] < sent[i]) {
        sum[i] = 0;
        for (const Vec3& d : suns[h].more) send(i, d);
        shadows.trace();
        share = sum[i] / static_cast<double>(suns[h].more.size());
      }
      for (const MirrorWay& way : suns[h].ways) share += over_way(rays, points[i], suns[h], way);
      out[i * suns.size() + h] = static_cast<float>(share);
    }
  }
}

}  // namespace clerestory
