#include "solver/lights/direct.h"

#include <algorithm>
#include <bit>
#include <numbers>

#include "solver/lights/point_lights.h"
#include "solver/lights/sun.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/units.h"
#include "solver/sampling.h"

namespace clerestory {
namespace {

enum StreamKind : std::uint64_t { kLampPoints = 0x11, kSkyRays = 0x12, kLampRays = 0x13 };

/// Adds to E_i the mean over points of patch i of the irradiance that open_at(point) gives where a segment to
/// end_for(point, u, v) is free.
class PatchSampler {
 public:
  PatchSampler(const Problem& problem, std::size_t patch, const DirectOptions& options)
      : problem_(problem),
        corners_(problem.patches.corner_positions(PatchId{patch})),
        normal_(problem.patches.normal[patch]),
        key_(stream_key(options.seed, kLampPoints, patch)),
        options_(options) {}

  const Vec3& normal() const { return normal_; }
  bool any_corner(const auto& predicate) const { return std::any_of(corners_.begin(), corners_.end(), predicate); }

  template <class Open, class End>
  Spectrum mean(const Open& open_at, const End& end_for) const {
    if (options_.edge_rays <= options_.lamp_rays)
      return look(key_, options_.lamp_rays, open_at, end_for).sum / options_.lamp_rays;
    // The pilot only decides. Its values, kept where it saw no edge, would lose the light of spots that it mostly
    // misses; rays that continue its sequence would find too much there, as they fall where its own did not.
    const Tally pilot = look(mix_bits(key_), options_.lamp_rays, open_at, end_for);
    const bool on_an_edge = pilot.visible > 0 && pilot.visible < pilot.facing;
    const int rays = on_an_edge ? options_.edge_rays : options_.lamp_rays;
    return look(key_, rays, open_at, end_for).sum / rays;
  }

 private:
  struct Tally {
    Spectrum sum{0.0};
    int facing = 0, visible = 0;
  };

  template <class Open, class End>
  Tally look(std::uint64_t key, int count, const Open& open_at, const End& end_for) const {
    const double lift = problem_.rays.lift();
    Tally tally;
    for (int first = 0; first < count; first += 16) {
      SegmentPacket segments;
      std::array<Spectrum, 16> open;
      std::array<Vec3, 16> from, to;
      unsigned facing = 0;
      for (int lane = 0; lane < 16; ++lane) {
        const auto k = static_cast<std::size_t>(lane);
        const auto u = sobol4(static_cast<std::uint32_t>(first + lane), key);
        from[k] = point_on_triangle(corners_, u[0], u[1]) + normal_ * lift;
        to[k] = end_for(from[k], u[2], u[3]);
        open[k] = open_at(from[k], to[k]);
        segments.set(lane, from[k], to[k]);
        if (!open[k].is_black()) facing |= 1u << lane;
      }
      const unsigned seen = problem_.rays.visible16(segments, static_cast<std::uint16_t>(facing));
      tally.facing += std::popcount(facing), tally.visible += std::popcount(seen);
      for (unsigned left = seen; left; left &= left - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(left));
        tally.sum += open[k] * problem_.rays.glass_transmittance(from[k], to[k]);
      }
    }
    return tally;
  }

  const Problem& problem_;
  std::array<Vec3, 3> corners_;
  Vec3 normal_;
  std::uint64_t key_;
  const DirectOptions& options_;
};

template <class Lamp>
Spectrum from_lamp(const PatchSampler& patch, const Lamp& lamp) {
  if (!patch.any_corner([&](const Vec3& c) { return dot(patch.normal(), lamp.position - c) > 0; }))
    return Spectrum(0.0);
  return patch.mean([&](const Vec3& p, const Vec3&) { return open_irradiance(lamp, p, patch.normal()); },
                    [&](const Vec3&, double, double) { return lamp.position; });
}

Spectrum from_sun(const PatchSampler& patch, const Sun& sun, double far_away) {
  if (dot(patch.normal(), sun.direction) < -0.01) return Spectrum(0.0);
  return patch.mean(
      [&](const Vec3& p, const Vec3& end) {
        return sun.normal_irradiance * std::max(0.0, dot(patch.normal(), end - p) / far_away);
      },
      [&](const Vec3& p, double u, double v) { return p + direction_to_sun(sun, u, v) * far_away; });
}

Spectrum from_sky(const Illumination& light, std::size_t patch, const DirectOptions& options) {
  const Problem& problem = light.problem;
  const Frame frame(problem.patches.normal[patch]);
  const auto corners = problem.patches.corner_positions(PatchId{patch});
  const std::uint64_t key = stream_key(options.seed, kSkyRays, patch);
  Spectrum sum(0.0);
  for (int k = 0; k < options.sky_rays; ++k) {
    const auto u = sobol4(static_cast<std::uint32_t>(k), key);
    const Ray ray{point_on_triangle(corners, u[2], u[3]) + frame.n * problem.rays.lift(),
                  cosine_direction(frame, u[0], u[1])};
    const Hit hit = problem.rays.first_hit(problem.patches, ray);
    if (hit.escaped()) sum += light.sky(ray.direction) * hit.transmittance;
  }
  return sum * (std::numbers::pi / options.sky_rays);
}

/// Where a luminaire's own rays end: on patches, outside, or in glass and sides that take no part.
template <class Lamp>
void balance_lamp(const Problem& problem, const Lamp& lamp, std::size_t number, DirectLight& direct,
                  const DirectOptions& options) {
  constexpr std::uint32_t kRays = 1 << 14;
  const std::uint64_t key = stream_key(options.seed, kLampRays, number);
  double sent = 0, arrived = 0, escaped = 0;
  for (std::uint32_t k = 0; k < kRays; ++k) {
    const auto u = sobol4(k, key);
    const Ray ray{lamp.position, sphere_direction(u[0], u[1])};
    const Hit hit = problem.rays.first_hit(problem.patches, ray);
    const Spectrum I = intensity(lamp, ray.direction);
    sent += luminous_mean(I);
    if (hit.escaped()) escaped += luminous_mean(I * hit.transmittance);
    if (hit.patch.valid()) arrived += luminous_mean(I * hit.transmittance);
  }
  const double flux = luminous_mean(power(lamp));
  direct.rays += kRays;
  direct.energy.emitted += flux;
  if (!(sent > 0)) return;
  direct.energy.escaped += flux * escaped / sent;
  direct.energy.absorbed += flux * (sent - arrived - escaped) / sent;
}

}  // namespace

DirectLight direct_light(const Illumination& light, const DirectOptions& options, const Monitor& monitor) {
  const Problem& problem = light.problem;
  const Lights& lights = problem.lights;
  const std::size_t n = problem.patches.patch_count();
  DirectLight direct;
  direct.E = Field(n, problem.patches.channels);
  if (lights.empty()) return direct;

  const double far_away = 4 * problem.rays.diameter();
  std::vector<double> daylight(n);  // [W] of each patch
  const auto light_patch = [&](std::size_t i, const DirectOptions& spend) {
    const PatchSampler patch(problem, i, spend);
    Spectrum lamps(0.0), sky(0.0);
    for (const auto& lamp : lights.points) lamps += from_lamp(patch, lamp);
    for (const auto& lamp : lights.spots) lamps += from_lamp(patch, lamp);
    for (const auto& sun : lights.suns) sky += from_sun(patch, sun, far_away);
    if (!light.sky.dark() && spend.sky_rays > 0) sky += from_sky(light, i, spend);
    direct.E.set(i, lamps + sky);
    daylight[i] = luminous_mean(sky) * problem.patches.area[i];
  };
  if (monitor.deadline != Monitor{}.deadline) {
    // Time may run out below: no patch shall stay dark for that.
    const DirectOptions rough{
        .lamp_rays = 16, .edge_rays = 16, .sky_rays = std::min(16, options.sky_rays), .seed = options.seed};
    parallel_for(n, 32, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) light_patch(i, rough);
    });
  }
  constexpr std::size_t kBlock = 1 << 11;
  for (std::size_t begin = 0; begin < n && !monitor.should_stop(); begin += kBlock) {
    monitor.report("direct", static_cast<double>(begin) / static_cast<double>(n));
    parallel_for(std::min(kBlock, n - begin), 32, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = begin + from; i < begin + to; ++i) light_patch(i, options);
    });
  }
  for (const double flux : daylight) direct.energy.emitted += flux;
  direct.rays += n * static_cast<std::size_t>(options.lamp_rays) *
                 (lights.points.size() + lights.spots.size() + lights.suns.size());
  if (!light.sky.dark()) direct.rays += n * static_cast<std::size_t>(options.sky_rays);
  std::size_t number = 0;
  for (const auto& lamp : lights.points) balance_lamp(problem, lamp, number++, direct, options);
  for (const auto& lamp : lights.spots) balance_lamp(problem, lamp, number++, direct, options);
  return direct;
}

}  // namespace clerestory
