#include "solver/gather_point.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numbers>
#include <vector>

#include "solver/model/random_stream.h"
#include "solver/model/units.h"
#include "solver/sampling.h"

namespace clerestory {
namespace {

/// The strata of a hemisphere: cell (i, j) is a square of cosine_direction()'s unit square. Cells are numbered in tiles
/// of 4 x 4, so that sixteen in a row make a coherent packet.
struct Strata {
  int grid;

  int count() const { return grid * grid; }
  std::array<int, 2> place(int cell) const {
    const int tile = cell / 16, in_tile = cell % 16, tiles = grid / 4;
    return {tile / tiles * 4 + in_tile / 4, tile % tiles * 4 + in_tile % 4};
  }
  int number(int i, int j) const {
    const int tiles = grid / 4;
    return (i / 4 * tiles + j / 4) * 16 + i % 4 * 4 + j % 4;
  }
  int number_of(const std::array<double, 2>& uv) const {
    return number(static_cast<int>(uv[0] * grid), static_cast<int>(uv[1] * grid));
  }
};

/// What comes back along rays, as radiosity: irradiance is its mean over cosine-distributed rays.
class Bundle {
 public:
  Bundle(const Illumination& light, const Vec3& p, const Frame& frame) : light_(light), p_(p), frame_(frame) {}

  Vec3 direction(double u, double v) const { return cosine_direction(frame_, u, v); }

  /// Up to 16 rays. density[k]: of bundle rays around ray k as a multiple of cos / pi; lamp_rays: shadow rays that
  /// share the bright patches.
  void look(std::span<const Vec3> directions, std::span<const double> density, int lamp_rays,
            std::span<Spectrum> values) const {
    std::array<Ray, 16> rays;
    std::array<Hit, 16> hits;
    for (std::size_t k = 0; k < directions.size(); ++k) rays[k] = {p_, directions[k]};
    const Problem& problem = light_.problem;
    problem.rays.first_hits(problem.patches, std::span(rays).first(directions.size()), hits);
    for (std::size_t k = 0; k < directions.size(); ++k) {
      const Hit& hit = hits[k];
      values[k] = Spectrum(0.0);
      if (hit.escaped()) {
        values[k] = light_.sky(directions[k]) * std::numbers::pi * hit.transmittance;
      } else if (hit.patch.valid()) {
        Spectrum back = light_.lamps.glow()[hit.patch];
        if (lamp_rays > 0 && light_.lamps.is_explicit(hit.patch)) {
          const double cos_patch = -dot(problem.patches.normal[hit.patch], directions[k]);
          const double bundle = density[k] * dot(frame_.n, directions[k]) / std::numbers::pi;
          const double lamp = lamp_rays * light_.lamps.density(hit.patch, p_, frame_.n, hit.distance, cos_patch, true);
          back *= bundle / (bundle + lamp);
        }
        values[k] = back * hit.transmittance;
      }
    }
  }

 private:
  const Illumination& light_;
  Vec3 p_;
  Frame frame_;
};

/// Rays for each stratum: one, and a share of the surplus in proportion to how much the pilot's neighbours differ.
std::vector<int> share_rays(const Strata& strata, const std::vector<double>& pilot, int rays) {
  const int g = strata.grid, n = strata.count();
  std::vector<double> difference(pilot.size());
  double sum_of_differences = 0, mean = 0;
  for (int i = 0; i < g; ++i)
    for (int j = 0; j < g; ++j) {
      double low = pilot[static_cast<std::size_t>(strata.number(i, j))], high = low;
      for (int di = -1; di <= 1; ++di)
        for (int dj = -1; dj <= 1; ++dj) {
          if (i + di < 0 || i + di >= g) continue;
          const double near = pilot[static_cast<std::size_t>(strata.number(i + di, (j + dj + g) % g))];
          low = std::min(low, near), high = std::max(high, near);
        }
      const auto cell = static_cast<std::size_t>(strata.number(i, j));
      difference[cell] = high - low;
      sum_of_differences += difference[cell];
      mean += pilot[cell];
    }
  std::vector<int> count(pilot.size(), 1);
  if (!(sum_of_differences > 0)) return count;
  // An even view needs no surplus: all of it is spent once neighbours differ by a quarter of the mean on average.
  const double surplus = std::max(0, rays - n) * std::min(1.0, 4 * sum_of_differences / std::max(mean, 1e-300));
  double owed = 0.5;
  for (std::size_t c = 0; c < count.size(); ++c) {
    owed += surplus * difference[c] / sum_of_differences;
    const int more = static_cast<int>(owed);
    count[c] += more;
    owed -= more;
  }
  return count;
}

Spectrum bright_patches(const Illumination& light, const Strata& strata, const std::vector<int>& count, const Vec3& p,
                        const Frame& frame, int lamp_rays, std::uint64_t key) {
  Spectrum sum(0.0);
  for (int first = 0; first < lamp_rays; first += 16) {
    SegmentPacket segments;
    std::array<Spectrum, 16> open;
    std::array<Vec3, 16> end;
    unsigned active = 0;
    for (int k = 0; k < 16; ++k) {
      const auto u = sobol4(static_cast<std::uint32_t>(first + k), key);
      const LightSample s = light.lamps.sample(p, frame.n, u[0], u[1], u[2], true);
      segments.set(k, p, s.density > 0 ? s.end : p);
      if (!(s.density > 0)) continue;
      const Vec3 d = normalized(s.end - p);
      const int cell = strata.number_of(square_of_direction(frame, d));
      const double bundle = count[static_cast<std::size_t>(cell)] * strata.count() * dot(frame.n, d) / std::numbers::pi;
      const double lamp = lamp_rays * s.density;
      active |= 1u << k;
      end[static_cast<std::size_t>(k)] = s.end;
      open[static_cast<std::size_t>(k)] = s.irradiance * (lamp / (lamp + bundle));
    }
    if (!active) continue;
    for (unsigned seen = light.problem.rays.visible16(segments, static_cast<std::uint16_t>(active)); seen;
         seen &= seen - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(seen));
      sum += open[k] * light.problem.rays.glass_transmittance(p, end[k]);
    }
  }
  return sum / lamp_rays;
}

}  // namespace

Spectrum gather_point(const Illumination& light, const Vec3& p, const Vec3& n, const GatherQuality& quality,
                      std::uint64_t key, unsigned long long& rays) {
  const Strata strata{quality.grid};
  const Frame frame(n);
  const Bundle bundle(light, p, frame);
  const int lamp_rays = light.lamps.has_emitters() ? quality.lamp_rays : 0;
  RandomStream random(key);

  std::array<Vec3, 16> directions;
  std::array<double, 16> density;
  std::array<Spectrum, 16> values;
  std::array<std::size_t, 16> cell_of;
  const auto direction_in = [&](int cell) {
    const auto [i, j] = strata.place(cell);
    const double u = (i + random.uniform()) / strata.grid, v = (j + random.uniform()) / strata.grid;
    return bundle.direction(u, v);
  };

  std::vector<int> count(static_cast<std::size_t>(strata.count()), 1);
  if (quality.rays > strata.count()) {
    std::vector<double> pilot(count.size());
    density.fill(strata.count());
    for (int first = 0; first < strata.count(); first += 16) {
      for (int k = 0; k < 16; ++k) directions[static_cast<std::size_t>(k)] = direction_in(first + k);
      bundle.look(directions, density, lamp_rays, values);
      for (int k = 0; k < 16; ++k)
        pilot[static_cast<std::size_t>(first + k)] = luminous_mean(values[static_cast<std::size_t>(k)]);
    }
    rays += pilot.size();
    count = share_rays(strata, pilot, quality.rays);
  }

  Spectrum sum(0.0);
  std::size_t queued = 0;
  const auto flush = [&] {
    bundle.look(std::span(directions).first(queued), std::span(density).first(queued), lamp_rays,
                std::span(values).first(queued));
    for (std::size_t k = 0; k < queued; ++k) sum += values[k] / count[cell_of[k]];
    rays += queued;
    queued = 0;
  };
  for (int cell = 0; cell < strata.count(); ++cell) {
    const auto c = static_cast<std::size_t>(cell);
    for (int k = 0; k < count[c]; ++k) {
      directions[queued] = direction_in(cell);
      density[queued] = static_cast<double>(count[c]) * strata.count();
      cell_of[queued++] = c;
      if (queued == 16) flush();
    }
  }
  flush();

  Spectrum E = sum / strata.count();
  if (lamp_rays > 0) {
    E += bright_patches(light, strata, count, p, frame, lamp_rays, key + 1);
    rays += static_cast<unsigned>(lamp_rays);
  }
  if (!light.problem.lights.empty()) E += light.lamps.small_lights(p, n, quality.sun_rays, key + 2);
  return E;
}

}  // namespace clerestory
