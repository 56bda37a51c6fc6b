#include "pipeline/annual/year_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "solver/illumination/find_images.h"
#include "solver/illumination/place_lights.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/paths/path_tracer.h"
#include "solver/run/accuracy.h"

namespace clerestory {
namespace {

constexpr double kNoise = 0.05;  ///< of a reference, relative: below it a point gets no more paths
constexpr int kMostRounds = 3;   ///< of twice as many paths each

/// `count` of those that count, evenly by the light of open ground.
std::vector<std::size_t> hours_to_look_at(std::span<const DaylightHour> hours, const YearRules& rules,
                                          std::size_t count) {
  std::vector<std::size_t> order;
  for (std::size_t h = 0; h < hours.size(); ++h)
    if (rules.occupied[h] > 0 || rules.daylight[h] > 0) order.push_back(h);
  const auto open_ground = [&](std::size_t h) {
    return hours[h].diffuse_horizontal_lux + hours[h].direct_normal_lux() * std::max(0.0, hours[h].sun.z);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return open_ground(a) < open_ground(b); });
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < std::min(count, order.size()); ++k)
    chosen.push_back(order[(2 * k + 1) * order.size() / (2 * std::min(count, order.size()))]);
  return chosen;
}

/// `count` of the points, evenly.
std::vector<PlacesOfPoint> even_choice(std::span<const PlacesOfPoint> points, std::span<const std::size_t> among,
                                       std::size_t count) {
  std::vector<PlacesOfPoint> chosen;
  const std::size_t n = std::min(count, among.size());
  for (std::size_t k = 0; k < n; ++k) chosen.push_back(points[among[(2 * k + 1) * among.size() / (2 * n)]]);
  return chosen;
}

/// Points that rooms are told by; all where there are none.
std::vector<std::size_t> points_of(const std::vector<YearArea>& areas, std::size_t all) {
  std::vector<std::size_t> points;
  for (const YearArea& area : areas) points.insert(points.end(), area.points.begin(), area.points.end());
  if (points.empty()) {
    points.resize(all);
    std::iota(points.begin(), points.end(), std::size_t{0});
  }
  return points;
}

LightSpec light_of(const DaylightHour& hour) {
  LightSpec light;
  light.sky = hour.sky;
  if (hour.sun_up) light.suns.push_back({hour.sun, Spectrum(hour.sun_normal_irradiance)});
  return light;
}

/// Upper end of the 95 % interval of the relative error of what is at least `least`. What its reference leaves open
/// weighs less.
double relative_error(std::span<const Comparison> found, double least) {
  double all = 0, sum = 0, weights = 0;
  const auto weight_of = [](const Comparison& c) {
    const double noise = c.std_error / (2 * kNoise * c.r);
    return 1 / (1 + noise * noise);
  };
  const auto square_of = [](const Comparison& c) {
    const double off = (c.x - c.r) / c.r, noise = c.std_error / c.r;
    return off * off - noise * noise;
  };
  for (const Comparison& c : found)
    if (c.r >= least) ++all, weights += weight_of(c), sum += weight_of(c) * square_of(c);
  if (all < 2) return 0;
  const double mean = sum / weights;
  double spread = 0;
  for (const Comparison& c : found)
    if (c.r >= least) spread += std::pow(weight_of(c) * (square_of(c) - mean), 2);
  return std::sqrt(std::max(0.0, mean) + 2 * std::sqrt(spread) / weights);
}

struct YearComparisons {
  std::vector<Comparison> total, direct;
};

/// Luminous mean at points by paths, noisy ones by more of them.
struct Reference {
  double r = 0, std_error = 0;
};
std::vector<Reference> references(const Illumination& light, std::span<const PlacesOfPoint* const> points, int paths,
                                  std::uint64_t key) {
  struct Sum {
    double paths = 0, r = 0, variance = 0;  ///< weighted by paths; its square
  };
  std::vector<Sum> sum(points.size());
  std::vector<std::size_t> open(points.size());
  std::iota(open.begin(), open.end(), std::size_t{0});
  for (int round = 0; round < kMostRounds && !open.empty(); ++round, paths *= 2) {
    std::vector<ReceivingPoint> places;
    for (const std::size_t p : open) places.insert(places.end(), points[p]->at.begin(), points[p]->at.end());
    const PointIrradiance found =
        trace_paths_at(light, places.size(), [&](std::size_t i) { return places[i]; }, paths,
                       stream_key(key, kYearErrorPaths, static_cast<std::uint64_t>(round)), "error", {});
    std::size_t place = 0;
    for (const std::size_t p : open) {
      double r = 0, variance = 0;
      for (const double weight : points[p]->weight) {
        r += weight * luminous_mean(found.E[place]);
        variance += std::pow(weight * luminous_mean(found.std_error[place]), 2);
        ++place;
      }
      sum[p].paths += paths, sum[p].r += paths * r, sum[p].variance += static_cast<double>(paths) * paths * variance;
    }
    std::erase_if(open, [&](std::size_t p) { return std::sqrt(sum[p].variance) <= kNoise * sum[p].r; });
  }
  std::vector<Reference> out;
  for (const Sum& s : sum) out.push_back({s.r / s.paths, std::sqrt(s.variance) / s.paths});
  return out;
}

/// All light of each hour at points of its own, as far as there are enough; direct sun at all of them.
YearComparisons compare(const WindowState& open, const Prepared& scene, std::span<const PlacesOfPoint> points,
                        const GatherPattern& pattern, std::span<const DaylightHour> hours,
                        std::span<const std::size_t> look_at, const YearEffort& spend, std::uint64_t seed,
                        const Monitor& monitor) {
  const std::size_t H = open.year().hours;
  std::vector<float> total(points.size() * H), direct(points.size() * H);
  constexpr std::size_t kBlock = 16;
  parallel_for((points.size() + kBlock - 1) / kBlock, 1, [&](std::size_t from, std::size_t to) {
    const std::size_t begin = from * kBlock, count = std::min(to * kBlock, points.size()) - begin;
    open.year_at(points.subspan(begin, count), pattern, std::span(total).subspan(begin * H, count * H),
                 std::span(direct).subspan(begin * H, count * H));
  });
  YearComparisons found;
  for (std::size_t k = 0; k < look_at.size(); ++k) {
    const std::size_t h = look_at[k];
    monitor.report("error", static_cast<double>(k) / static_cast<double>(look_at.size()));
    Lights lights = to_local_frame(light_of(hours[h]), scene.patches.origin);
    add_images(lights, scene.patches, scene.rays);
    lights.openings = scene.lights.openings;
    const Problem problem{open.problem().patches, scene.rays, lights};
    const Illumination light(problem);
    std::vector<std::size_t> number;
    std::vector<const PlacesOfPoint*> own;
    const std::size_t each = (points.size() + look_at.size() - 1) / look_at.size();
    for (std::size_t j = 0; j < each; ++j)
      number.push_back((k * each + j) % points.size()), own.push_back(&points[number.back()]);
    const std::vector<Reference> reference =
        references(light, own, spend.error_paths, stream_key(seed, kYearErrorPaths, h));
    for (std::size_t j = 0; j < own.size(); ++j)
      found.total.push_back(
          {.x = total[number[j] * H + h] / kWhiteEfficacy, .r = reference[j].r, .std_error = reference[j].std_error});
    const std::size_t first = found.direct.size();
    found.direct.resize(first + points.size());
    parallel_for(points.size(), 4, [&](std::size_t from, std::size_t to) {
      for (std::size_t p = from; p < to; ++p) {
        Comparison& of_direct = found.direct[first + p];
        of_direct.x = direct[p * H + h] / kWhiteEfficacy;
        for (std::size_t s = 0; s < points[p].at.size(); ++s)
          of_direct.r +=
              points[p].weight[s] * luminous_mean(light.sampler.delta_light(points[p].at[s].p, points[p].at[s].n,
                                                                            {.sun_rays = spend.error_sun_rays},
                                                                            stream_key(seed, kYearErrorPoints, h)));
      }
    });
  }
  return found;
}

YearError error_of(const YearComparisons& found, double threshold) {
  constexpr double kPart = 1.0 / 3;  // of a threshold, from which on an illuminance may be wrong about it
  return {relative_error(found.total, kPart * threshold / kWhiteEfficacy),
          relative_error(found.direct, kPart * kSunLux / kWhiteEfficacy)};
}

}  // namespace

void measure_year_error(const WindowState& open, const Prepared& scene, std::span<const PlacesOfPoint> points,
                        const GatherPattern& of_points, std::span<const PlacesOfPoint> sensors,
                        const GatherPattern& of_sensors, std::span<const DaylightHour> hours, const SolveOptions& solve,
                        const Monitor& monitor, YearSolved& out) {
  const YearEffort spend = effort(solve.accuracy).year;
  const std::vector<std::size_t> look_at = hours_to_look_at(hours, out.rules, spend.error_hours);
  const auto measure = [&](std::span<const PlacesOfPoint> all, const std::vector<YearArea>& areas,
                           const GatherPattern& pattern, std::optional<ErrorFigures>& figures, YearError& error) {
    if (all.empty()) return;
    const std::size_t count = look_at.size() * spend.error_points / (sensors.empty() ? 1 : 2);
    const YearComparisons found = compare(open, scene, even_choice(all, points_of(areas, all.size()), count), pattern,
                                          hours, look_at, spend, solve.seed, monitor);
    figures = summarise(found.total);
    error = error_of(found, out.rules.threshold);
  };
  measure(sensors, out.grids, of_sensors, out.error_sensors, out.error_of_sensors);
  measure(points, out.rooms, of_points, out.error_points, out.error_of_points);
}

}  // namespace clerestory
