#include "solver/lights/light_sampler.h"

#include <algorithm>
#include <numbers>

#include "solver/lights/point_lights.h"
#include "solver/lights/sun.h"
#include "solver/model/random_stream.h"
#include "solver/model/units.h"
#include "solver/sampling.h"

namespace clerestory {
namespace {

/// Half of the area of all patches glows no more than this (luminous mean).
double area_median(const PatchSet& patches, const Field& glow) {
  std::vector<std::pair<double, double>> by_glow;  // with area
  double half = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    by_glow.emplace_back(luminous_mean(glow[i]), patches.area[i]);
    half += patches.area[i] / 2;
  }
  std::sort(by_glow.begin(), by_glow.end());
  for (const auto& [value, area] : by_glow)
    if ((half -= area) <= 0) return value;
  return 0;
}

}  // namespace

LightSampler::LightSampler(const Problem& problem, const Field& glow) : problem_(problem), glow_(glow) {
  const PatchSet& patches = problem.patches;
  const std::size_t n = patches.patch_count();
  double total = 0;
  const auto add = [&](Kind kind, std::size_t index, double power) {
    if (!(power > 0)) return;
    lights_.push_back({kind, static_cast<std::uint32_t>(index), 0, 0, power, 0});
    total += power;
  };
  // Emitters first, so that their part of the cumulative table stands alone.
  const double bright = kBrighter * area_median(patches, glow);
  for (std::size_t i = 0; i < n; ++i)
    if (const double B = luminous_mean(glow[i]); B > bright) add(Kind::patch, i, B * patches.area[i]);
  has_emitters_ = !lights_.empty();
  const double emitters_total = total;
  for (std::size_t i = 0; i < problem.lights.points.size(); ++i)
    add(Kind::point, i, luminous_mean(power(problem.lights.points[i])));
  for (std::size_t i = 0; i < problem.lights.spots.size(); ++i)
    add(Kind::spot, i, luminous_mean(power(problem.lights.spots[i])));
  const double cross_section = std::numbers::pi / 4 * problem.rays.diameter() * problem.rays.diameter();
  for (std::size_t i = 0; i < problem.lights.suns.size(); ++i)
    add(Kind::sun, i, luminous_mean(problem.lights.suns[i].normal_irradiance) * cross_section);

  double sum = 0;
  for (Light& light : lights_) {
    const double light_power = light.share;
    sum += light_power;
    light.share = light_power / total;
    light.cumulative = sum / total;
    light.share_emitters = emitters_total > 0 ? light_power / emitters_total : 0;
    light.cumulative_emitters = emitters_total > 0 ? std::min(sum / emitters_total, 1.0) : 0;
  }
  if (has_emitters_) {
    emitters_share_ = emitters_total / total;
    explicit_.assign(n, false);
    share_of_patch_.assign(n, 0.0);
    for (const Light& light : lights_)
      if (light.kind == Kind::patch) {
        explicit_[light.index] = true;
        share_of_patch_[light.index] = light.share;
      }
  }
}

LightSample LightSampler::sample(const Vec3& p, const Vec3& n, double pick, double u, double v,
                                 bool emitters_only) const {
  const auto cumulative = emitters_only ? &Light::cumulative_emitters : &Light::cumulative;
  auto light = std::upper_bound(lights_.begin(), lights_.end(), pick,
                                [&](double x, const Light& l) { return x < l.*cumulative; });
  if (light == lights_.end()) --light;
  const double share = emitters_only ? light->share_emitters : light->share;
  const double lift = problem_.rays.lift();
  switch (light->kind) {
    case Kind::patch: {
      const PatchId q{light->index};
      const Vec3 normal = problem_.patches.normal[q];
      const Vec3 point = point_on_triangle(problem_.patches.corner_positions(q), u, v);
      const double kernel = point_kernel(p, n, point, normal);
      if (kernel == 0) return {};
      const Vec3 d = point - p;
      const double r2 = dot(d, d), cos_q = -dot(normal, d) / std::sqrt(r2);
      return {point + normal * lift, glow_[q] * (kernel * problem_.patches.area[q] / share),
              share * r2 / (cos_q * problem_.patches.area[q]), q};
    }
    case Kind::point: {
      const PointLuminaire& lamp = problem_.lights.points[light->index];
      return {lamp.position, open_irradiance(lamp, p, n) / share, 0, {}};
    }
    case Kind::spot: {
      const SpotLuminaire& lamp = problem_.lights.spots[light->index];
      return {lamp.position, open_irradiance(lamp, p, n) / share, 0, {}};
    }
    case Kind::sun: {
      const Sun& sun = problem_.lights.suns[light->index];
      const Vec3 d = direction_to_sun(sun, u, v);
      const double cos_n = dot(n, d);
      if (!(cos_n > 0)) return {};
      return {p + d * (4 * problem_.rays.diameter()), sun.normal_irradiance * (cos_n / share), 0, {}};
    }
  }
  return {};
}

double LightSampler::density(PatchId q, const Vec3& /*p*/, const Vec3& /*n*/, double distance, double cos_q,
                             bool emitters_only) const {
  if (!(cos_q > 0)) return 0;
  const double share = share_of_patch_[q] / (emitters_only ? emitters_share_ : 1.0);
  return share * distance * distance / (cos_q * problem_.patches.area[q]);
}

Spectrum LightSampler::small_lights(const Vec3& p, const Vec3& n, int sun_rays, std::uint64_t key) const {
  Spectrum E(0.0);
  const auto add_lamp = [&](const auto& lamp) {
    const Spectrum open = open_irradiance(lamp, p, n);
    if (!open.is_black()) E += open * problem_.rays.transmittance(p, lamp.position);
  };
  for (const auto& lamp : problem_.lights.points) add_lamp(lamp);
  for (const auto& lamp : problem_.lights.spots) add_lamp(lamp);
  for (const Sun& sun : problem_.lights.suns) {
    Spectrum sum(0.0);
    for (int k = 0; k < sun_rays; ++k) {
      const auto u = sobol4(static_cast<std::uint32_t>(k), key);
      const Vec3 d = direction_to_sun(sun, u[0], u[1]);
      const double cos_n = dot(n, d);
      if (cos_n > 0) sum += problem_.rays.transmittance(p, p + d * (4 * problem_.rays.diameter())) * cos_n;
    }
    E += sun.normal_irradiance * sum / sun_rays;
  }
  return E;
}

}  // namespace clerestory
