#include "solver/illumination/sharp_light.h"

#include <algorithm>
#include <array>
#include <utility>

#include "solver/illumination/image_beams.h"
#include "solver/lights/luminaire.h"
#include "solver/lights/sun.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr int kRimRays = 16;
constexpr double kRim = 1 - 1e-9;  // of the disc, which ends before 1

}  // namespace

double SharpLight::open_irradiance(const Vec3& p, const Vec3& n) const {
  if (luminaire_) return luminaire_->share * luminous_mean(clerestory::open_irradiance(*luminaire_, p, n));
  return sun_->share * luminous_mean(sun_->normal_irradiance) * std::max(0.0, dot(n, sun_->direction));
}

bool SharpLight::may_reach(std::span<const Vec3, 3> corners) const {
  return !sun_ || clerestory::may_reach(problem_->rays, *sun_, corners);
}

ShadowSegment SharpLight::to_centre(const Vec3& p, const Vec3& n) const {
  const Vec3 from = problem_->rays.off_surface(p, n);
  if (luminaire_) return shadow_segment(*luminaire_, luminaire_->position, from);
  return {from, from + sun_->direction * (4 * problem_->rays.diameter()), false};
}

ShadowSegment SharpLight::to_rim(const Vec3& from, int k) const {
  const double around = static_cast<double>(k) / kRimRays;
  if (luminaire_) return shadow_segment(*luminaire_, rim_point(*luminaire_, from, around), from);
  return {from, from + direction_to_sun(*sun_, kRim, around) * (4 * problem_->rays.diameter()), false};
}

std::uint16_t SharpLight::free(std::span<const ShadowSegment> segments) const {
  const RayScene& rays = problem_->rays;
  const MirrorWay& way = sun_ ? sun_->way : luminaire_->way;
  unsigned free = 0;
  for (std::size_t k = 0; k < segments.size(); ++k) free |= segments[k].is_free ? 1u << k : 0u;
  if (way.empty()) {
    SegmentPacket packet;
    for (std::size_t k = 0; k < segments.size(); ++k) packet.set(static_cast<int>(k), segments[k].from, segments[k].to);
    const auto asked = static_cast<std::uint16_t>(((1u << segments.size()) - 1) & ~free);
    return static_cast<std::uint16_t>(rays.visible16(packet, asked) | free);
  }
  for (std::size_t k = 0; k < segments.size(); ++k)
    if (!segments[k].is_free && !rays.transmittance_by_mirrors(segments[k].from, segments[k].to, way).is_black())
      free |= 1u << k;
  return static_cast<std::uint16_t>(free);
}

std::uint16_t SharpLight::see_centre(std::span<const Vec3> points, const Vec3& n) const {
  std::array<ShadowSegment, 16> segments;
  for (std::size_t k = 0; k < points.size(); ++k) segments[k] = to_centre(points[k], n);
  return free(std::span(segments).first(points.size()));
}

LightSeen SharpLight::seen(const Vec3& p, const Vec3& n) const {
  if (luminaire_ && opening_rays(*luminaire_, p) == 1) return sees_centre(p, n) ? LightSeen::all : LightSeen::none;
  const Vec3 from = problem_->rays.off_surface(p, n);
  std::array<ShadowSegment, kRimRays> segments;
  for (int k = 0; k < kRimRays; ++k) segments[static_cast<std::size_t>(k)] = to_rim(from, k);
  const std::uint16_t seen = free(segments);
  return seen == 0 ? LightSeen::none : seen == 0xffff ? LightSeen::all : LightSeen::part;
}

std::vector<SharpLight> sharp_lights(const Problem& problem, std::size_t most) {
  std::vector<SharpLight> lights;
  for (const PlacedSun& sun : problem.lights.suns) lights.emplace_back(problem, sun);
  std::vector<std::pair<double, std::uint32_t>> by_power;
  for (const PlacedLuminaire& luminaire : problem.lights.luminaires)
    by_power.emplace_back(-luminaire.share * luminous_mean(power(luminaire)),
                          static_cast<std::uint32_t>(by_power.size()));
  if (by_power.size() > most) {
    std::sort(by_power.begin(), by_power.end());
    by_power.resize(most);
  }
  for (const auto& [less, number] : by_power) lights.emplace_back(problem, problem.lights.luminaires[number]);
  return lights;
}

}  // namespace clerestory
