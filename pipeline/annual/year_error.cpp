#include "pipeline/annual/year_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "solver/illumination/find_images.h"
#include "solver/illumination/place_lights.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/paths/path_tracer.h"

namespace clerestory {
namespace {

struct Counts {
  std::size_t hours, points;
  int paths, sun_rays;
};
Counts counts_of(Accuracy accuracy) {
  if (accuracy == Accuracy::draft) return {8, 12, 256, 64};
  if (accuracy == Accuracy::standard) return {16, 16, 512, 256};
  return {32, 24, 1024, 1024};
}

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

std::vector<PlacesOfPoint> even_choice(std::span<const PlacesOfPoint> points, std::size_t count) {
  std::vector<PlacesOfPoint> chosen;
  const std::size_t n = std::min(count, points.size());
  for (std::size_t k = 0; k < n; ++k) chosen.push_back(points[(2 * k + 1) * points.size() / (2 * n)]);
  return chosen;
}

LightSpec light_of(const DaylightHour& hour) {
  LightSpec light;
  light.sky = hour.sky;
  if (hour.sun_up) light.suns.push_back({hour.sun, Spectrum(hour.sun_normal_irradiance)});
  return light;
}

/// Upper end of the 95 % interval of the relative error of what is worth a threshold.
double relative_error(std::span<const Comparison> found, double least) {
  double n = 0, sum = 0, squares = 0;
  for (const Comparison& c : found) {
    if (!(c.r >= least)) continue;
    const double off = (c.x - c.r) / c.r, noise = c.std_error / c.r, square = off * off - noise * noise;
    ++n, sum += square, squares += square * square;
  }
  if (n < 2) return 0;
  const double mean = sum / n, variance = std::max(0.0, squares / n - mean * mean) / (n - 1);
  return std::min(0.9, std::sqrt(std::max(0.0, mean) + 2 * std::sqrt(variance)));
}

struct YearComparisons {
  std::vector<Comparison> total, direct;
};

YearComparisons compare(const WindowState& open, const Prepared& scene, std::span<const PlacesOfPoint> points,
                        const GatherPattern& pattern, std::span<const DaylightHour> hours,
                        std::span<const std::size_t> look_at, const Counts& counts, std::uint64_t seed,
                        const Monitor& monitor) {
  const std::size_t H = open.year().hours;
  std::vector<float> total(points.size() * H), direct(points.size() * H);
  open.year_at(points, pattern, total, direct);
  std::vector<ReceivingPoint> places;
  for (const PlacesOfPoint& point : points) places.insert(places.end(), point.at.begin(), point.at.end());
  YearComparisons found;
  for (std::size_t k = 0; k < look_at.size(); ++k) {
    const std::size_t h = look_at[k];
    monitor.report("error", static_cast<double>(k) / static_cast<double>(look_at.size()));
    Lights lights = to_local_frame(light_of(hours[h]), scene.patches.origin);
    add_images(lights, scene.patches, scene.rays);
    lights.openings = scene.lights.openings;
    const Problem problem{open.problem().patches, scene.rays, lights};
    const Illumination light(problem);
    const PointIrradiance r = trace_paths_at(light, places.size(), [&](std::size_t i) { return places[i]; },
                                             counts.paths, stream_key(seed, kYearErrorPaths, h), "error", {});
    std::size_t place = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      Comparison of_total{.x = total[p * H + h] / kWhiteEfficacy}, of_direct{.x = direct[p * H + h] / kWhiteEfficacy};
      double variance = 0;
      for (std::size_t s = 0; s < points[p].at.size(); ++s, ++place) {
        const double weight = points[p].weight[s], noise = weight * luminous_mean(r.std_error[place]);
        of_total.r += weight * luminous_mean(r.E[place]);
        variance += noise * noise;
        of_direct.r += weight * luminous_mean(light.sampler.delta_light(places[place].p, places[place].n,
                                                                        {.sun_rays = counts.sun_rays},
                                                                        stream_key(seed, kYearErrorPoints, h)));
      }
      of_total.std_error = std::sqrt(variance);
      found.total.push_back(of_total);
      found.direct.push_back(of_direct);
    }
  }
  return found;
}

}  // namespace

void measure_year_error(const WindowState& open, const Prepared& scene, std::span<const PlacesOfPoint> points,
                        const GatherPattern& of_points, std::span<const PlacesOfPoint> sensors,
                        const GatherPattern& of_sensors, std::span<const DaylightHour> hours, const SolveOptions& solve,
                        const Monitor& monitor, YearSolved& out) {
  constexpr double kPart = 1.0 / 3;  // of a threshold, from which on an illuminance may be wrong about it
  const Counts counts = counts_of(solve.accuracy);
  const std::vector<std::size_t> look_at = hours_to_look_at(hours, out.rules, counts.hours);
  const bool by_sensors = !sensors.empty();
  const YearComparisons found =
      compare(open, scene, even_choice(by_sensors ? sensors : points, counts.points),
              by_sensors ? of_sensors : of_points, hours, look_at, counts, solve.seed, monitor);
  (by_sensors ? out.error_sensors : out.error_points) = summarise(found.total);
  out.error.total = relative_error(found.total, kPart * out.rules.threshold / kWhiteEfficacy);
  out.error.direct = relative_error(found.direct, kPart * kSunLux / kWhiteEfficacy);
}

}  // namespace clerestory
