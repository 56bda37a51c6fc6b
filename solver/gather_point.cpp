#include "solver/gather_point.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>

#include "solver/model/units.h"
#include "solver/sampling.h"

namespace clerestory {
namespace {

/// What comes back along rays, as radiosity: irradiance is its mean over cosine-distributed rays.
class Bundle {
 public:
  Bundle(const Illumination& light, const Vec3& p, const Frame& frame, int lamp_rays)
      : light_(light), p_(p), frame_(frame), lamp_rays_(lamp_rays) {}

  Vec3 direction(const std::array<float, 3>& d) const { return frame_.to_world(d[0], d[1], d[2]); }

  /// Up to 16 rays. density[k]: of bundle rays around ray k as a multiple of cos / pi.
  void look(std::span<const Vec3> directions, std::span<const double> density, std::span<Spectrum> values) const {
    std::array<Ray, 16> rays;
    std::array<Hit, 16> hits;
    for (std::size_t k = 0; k < directions.size(); ++k) rays[k] = {p_, directions[k]};
    const Problem& problem = light_.problem;
    problem.rays.first_hits(problem.patches, std::span(rays).first(directions.size()), hits);
    for (std::size_t k = 0; k < directions.size(); ++k) {
      const Hit& hit = hits[k];
      values[k] = Spectrum(0.0);
      if (hit.escaped()) {
        values[k] = light_.sky(hit.direction(rays[k])) * std::numbers::pi * hit.transmittance;
      } else if (hit.patch.valid()) {
        Spectrum back = light_.lamps.glow()[hit.patch];
        if (lamp_rays_ > 0 && !hit.reflected && light_.lamps.is_explicit(hit.patch)) {
          const double cos_patch = -dot(problem.patches.normal[hit.patch], directions[k]);
          const double bundle = density[k] * dot(frame_.n, directions[k]) / std::numbers::pi;
          const double lamp = lamp_rays_ * light_.lamps.density(hit.patch, p_, frame_.n, hit.distance, cos_patch, true);
          back *= bundle / (bundle + lamp);
        }
        values[k] = back * hit.transmittance;
      }
    }
  }

 private:
  const Illumination& light_;
  Vec3 p_;
  const Frame& frame_;
  int lamp_rays_;
};

int lamp_rays(const Illumination& light, const GatherPattern& pattern) {
  return light.lamps.has_emitters() ? pattern.quality().lamp_rays : 0;
}

Spectrum bright_patches(const Illumination& light, const Vec3& p, const Frame& frame, const GatherPattern& pattern,
                        const RayShares& shares) {
  const int count = pattern.quality().lamp_rays;
  Spectrum sum(0.0);
  for (int first = 0; first < count; first += 16) {
    SegmentPacket segments;
    std::array<Spectrum, 16> open;
    std::array<Vec3, 16> end;
    unsigned active = 0;
    for (int lane = 0; lane < 16; ++lane) {
      const auto k = static_cast<std::size_t>(lane);
      const auto& u = pattern.lamp_choices()[static_cast<std::size_t>(first) + k];
      const LightSample s = light.lamps.sample(p, frame.n, u[0], u[1], u[2], true);
      segments.set(lane, p, s.density > 0 ? s.end : p);
      if (!(s.density > 0)) continue;
      const Vec3 d = normalized(s.end - p);
      const int share =
          shares.empty() ? pattern.least() : shares[static_cast<std::size_t>(pattern.stratum_of(frame, d))];
      const double bundle = std::ldexp(pattern.strata(), share) * dot(frame.n, d) / std::numbers::pi;
      const double lamp = count * s.density;
      active |= 1u << lane;
      end[k] = s.end;
      open[k] = s.irradiance * (lamp / (lamp + bundle));
    }
    if (!active) continue;
    for (unsigned seen = light.problem.rays.visible16(segments, static_cast<std::uint16_t>(active)); seen;
         seen &= seen - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(seen));
      sum += open[k] * light.problem.rays.glass_transmittance(p, end[k]);
    }
  }
  return sum / count;
}

}  // namespace

bool wants_pilot(const Illumination& light, const GatherPattern& pattern) {
  return pattern.deepest() > pattern.least() && !light.sky.dark();
}

RayShares share_rays(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                     unsigned long long& rays) {
  const int strata = pattern.strata(), g = pattern.quality().grid;
  const auto count = static_cast<std::size_t>(strata);
  const Frame frame(n);
  const Bundle bundle(light, p, frame, lamp_rays(light, pattern));
  std::vector<double> pilot(count), difference(count);
  std::array<Vec3, 16> directions;
  std::array<double, 16> density;
  std::array<Spectrum, 16> values;
  density.fill(std::ldexp(strata, pattern.least()));
  for (int first = 0; first < strata; first += 16) {
    for (int k = 0; k < 16; ++k) directions[static_cast<std::size_t>(k)] = bundle.direction(pattern.pilot(first + k));
    bundle.look(directions, density, values);
    for (int k = 0; k < 16; ++k)
      pilot[static_cast<std::size_t>(first + k)] = luminous_mean(values[static_cast<std::size_t>(k)]);
  }
  rays += count;

  double sum_of_differences = 0, sum = 0;
  for (int i = 0; i < g; ++i)
    for (int j = 0; j < g; ++j) {
      const auto cell = static_cast<std::size_t>(pattern.stratum(i, j));
      double low = pilot[cell], high = low;
      for (int di = -1; di <= 1; ++di)
        for (int dj = -1; dj <= 1; ++dj) {
          if (i + di < 0 || i + di >= g) continue;
          const double near = pilot[static_cast<std::size_t>(pattern.stratum(i + di, (j + dj + g) % g))];
          low = std::min(low, near), high = std::max(high, near);
        }
      difference[cell] = high - low;
      sum_of_differences += difference[cell];
      sum += pilot[cell];
    }
  RayShares shares(count, static_cast<std::uint8_t>(pattern.least()));
  if (!(sum_of_differences > 0)) return shares;
  // An even view needs no surplus: all of it is spent once neighbours differ by a quarter of the mean on average.
  const auto& quality = pattern.quality();
  const double surplus = (quality.most_rays - quality.rays) * std::min(1.0, 4 * sum_of_differences / sum);
  const double least = std::ldexp(1, pattern.least());
  for (std::size_t c = 0; c < count; ++c) {
    const double wanted = least + surplus * difference[c] / sum_of_differences;
    shares[c] = static_cast<std::uint8_t>(
        std::clamp(static_cast<int>(std::lround(std::log2(wanted))), pattern.least(), pattern.deepest()));
  }
  return shares;
}

PointLight gather_point(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                        const RayShares& shares, unsigned long long& rays) {
  const int strata = pattern.strata(), to_lamps = lamp_rays(light, pattern);
  const Frame frame(n);
  const Bundle bundle(light, p, frame, to_lamps);
  std::array<Vec3, 16> directions;
  std::array<double, 16> density;
  std::array<Spectrum, 16> values;
  std::size_t queued = 0;
  Spectrum sum(0.0);
  double noise = 0;
  const auto flush = [&] {
    bundle.look(std::span(directions).first(queued), std::span(density).first(queued), std::span(values).first(queued));
    for (std::size_t k = 0; k < queued; ++k) sum += values[k] / density[k];
    for (std::size_t k = 0; k + 1 < queued; k += 2) {
      const double difference = luminous_mean(values[k]) / density[k] - luminous_mean(values[k + 1]) / density[k + 1];
      noise += difference * difference;
    }
    rays += queued;
    queued = 0;
  };
  for (int cell = 0; cell < strata; ++cell) {
    const int share = shares.empty() ? pattern.least() : shares[static_cast<std::size_t>(cell)];
    const double weight = std::ldexp(strata, share);
    for (const auto& d : pattern.directions(cell).first(std::size_t{1} << share)) {
      directions[queued] = bundle.direction(d);
      density[queued++] = weight;
      if (queued == 16) flush();
    }
  }
  if (queued) flush();

  PointLight at{sum, Spectrum(0.0), std::sqrt(noise)};
  if (to_lamps > 0) {
    at.E += bright_patches(light, p, frame, pattern, shares);
    rays += static_cast<unsigned>(to_lamps);
  }
  if (!light.problem.lights.empty()) {
    at.small_lights = light.lamps.small_lights(p, n, pattern.quality().sun_rays, pattern.sun_key());
    at.E += at.small_lights;
  }
  return at;
}

PointLight gather_point(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                        unsigned long long& rays) {
  return gather_point(light, p, n, pattern,
                      wants_pilot(light, pattern) ? share_rays(light, p, n, pattern, rays) : RayShares{}, rays);
}

}  // namespace clerestory
