#include "solver/annual/year_at_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "solver/gather/gather_point.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"

namespace clerestory {
namespace {

constexpr double kAroundDeg = 15;

/// Which fine parts of the sky lie around one of which a point sees something.
std::vector<bool> parts_near_seen(const YearScene& scene, const PointCoefficients& point) {
  std::vector<bool> near(scene.fine.count(), false);
  for (std::size_t k = 0; k < near.size(); ++k)
    if (point.straight[k] > 0)
      for (const std::uint32_t around : scene.parts_around[k]) near[around] = true;
  return near;
}

/// Of the directions of each part's rays, all parts within kAroundDeg.
std::vector<std::vector<std::uint32_t>> parts_around(const SkyParts& parts) {
  const double least = std::cos(kAroundDeg * std::numbers::pi / 180);
  std::vector<std::vector<std::uint32_t>> around(parts.count());
  for (std::size_t a = 0; a < parts.count(); ++a)
    for (std::uint32_t b = 0; b < parts.count(); ++b)
      if (dot(parts.middle(a), parts.middle(b)) >= least) around[a].push_back(b);
  return around;
}

/// Plans of points that look alike.
class SharedPlans {
 public:
  SharedPlans(const YearScene& scene, const GatherPattern& pattern)
      : scene_(scene), pattern_(pattern), wants_(wants_plan(scene.light, pattern)) {}

  const GatherPlan& at(const ReceivingPoint& point, unsigned long long& rays) {
    constexpr double kAlike = 0.9999;
    if (!wants_) return none_;
    for (const auto& [made_at, plan] : plans_)
      if (dot(made_at.n, point.n) > kAlike && length(made_at.p - point.p) <= scene_.plan_reach) return plan;
    plans_.push_back({point, plan_gather(scene_.light, point.p, point.n, pattern_, rays)});
    return plans_.back().second;
  }

 private:
  const YearScene& scene_;
  const GatherPattern& pattern_;
  bool wants_;
  GatherPlan none_;
  std::vector<std::pair<ReceivingPoint, GatherPlan>> plans_;
};

}  // namespace

YearScene year_scene(const Illumination& light, const SkyParts& fine, const ReflectedDaylight& reflected,
                     const YearLight& year, std::span<const DaylightHour> hours, double plan_reach,
                     std::size_t sun_rays, std::uint64_t seed) {
  YearScene scene{light, fine, reflected, year, {}, {}, {}, plan_reach, parts_around(fine)};
  for (std::size_t h = 0; h < hours.size(); ++h) {
    if (!(year.sun[h] > 0)) continue;
    std::vector<MirrorWay> ways;  // of all nodes around it, each once
    const AmongNodes& among = year.of_sun[h];
    for (std::size_t k = 0; k < among.node.size() && !reflected.sun_ways.empty(); ++k)
      for (const MirrorWay& way : reflected.sun_ways[among.node[k]])
        if (among.weight[k] > 0 && std::ranges::none_of(ways, [&](const MirrorWay& w) {
              return w.count == way.count && w.plane == way.plane;
            }))
          ways.push_back(way);
    scene.suns.emplace_back(hours[h].sun, std::move(ways), sun_rays,
                            stream_key(seed, kSunOfHour, static_cast<std::uint64_t>(hours[h].hour)));
    scene.hour_of_sun.push_back(h);
    scene.part_of_sun.push_back(static_cast<std::uint32_t>(fine.part_of(hours[h].sun)));
  }
  return scene;
}

void year_at(const YearScene& scene, std::span<const PlacesOfPoint> points, const GatherPattern& pattern, RowSums& sums,
             std::span<float> total, std::span<float> direct) {
  unsigned long long rays = 0;  // gathers count them
  LightRow row;
  std::vector<PointCoefficients> coefficients(
      points.size(), {std::vector<float>(scene.fine.count() + 1), std::vector<float>(scene.reflected.lanes)});
  SharedPlans plans(scene, pattern);
  std::vector<ReceivingPoint> places;
  std::vector<bool> may_come;
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (std::size_t k = 0; k < points[p].at.size(); ++k) {
      const ReceivingPoint& at = points[p].at[k];
      gather_point(scene.light, at.p, at.n, pattern, plans.at(at, rays), rays, &row);
      add_row(row, at.n, scene.fine, scene.reflected, points[p].weight[k], sums, coefficients[p]);
    }
    const std::vector<bool> near = parts_near_seen(scene, coefficients[p]);
    for (const ReceivingPoint& at : points[p].at) {
      places.push_back(at);
      for (const std::uint32_t part : scene.part_of_sun) may_come.push_back(near[part]);
    }
  }
  const std::size_t suns = scene.suns.size();
  std::vector<float> at_places(places.size() * suns);
  sun_on_points(scene.light.problem.rays, places, scene.suns, may_come, at_places);
  const std::size_t H = scene.year.hours;
  std::vector<float> sun(points.size() * H);
  std::size_t place = 0;
  for (std::size_t p = 0; p < points.size(); ++p)
    for (std::size_t k = 0; k < points[p].at.size(); ++k, ++place)
      for (std::size_t s = 0; s < suns; ++s)
        sun[p * H + scene.hour_of_sun[s]] += static_cast<float>(points[p].weight[k]) * at_places[place * suns + s];
  series_of(scene.year, coefficients, sun, total, direct);
}

}  // namespace clerestory
