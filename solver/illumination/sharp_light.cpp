#include "solver/illumination/sharp_light.h"

#include <algorithm>

#include "solver/lights/luminaire.h"
#include "solver/lights/sun.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr int kRimRays = 16;
constexpr double kRim = 1 - 1e-9;  // of the disc, which ends before 1

}  // namespace

double SharpLight::open_irradiance(const Vec3& p, const Vec3& n) const {
  if (luminaire_) return luminous_mean(clerestory::open_irradiance(*luminaire_, p, n));
  return luminous_mean(sun_->normal_irradiance) * std::max(0.0, dot(n, sun_->direction));
}

void SharpLight::segment(const Vec3& p, const Vec3& n, Vec3& from, Vec3& to) const {
  const double lift = problem_->rays.lift();
  from = p + n * lift;
  to = luminaire_ ? short_of(luminaire_->position, from, lift)
                  : from + sun_->direction * (4 * problem_->rays.diameter());
}

bool SharpLight::sees_centre(const Vec3& p, const Vec3& n) const {
  Vec3 from, to;
  segment(p, n, from, to);
  return problem_->rays.visible(from, to);
}

Vec3 SharpLight::rim(const Vec3& p, int k) const {
  const double around = static_cast<double>(k) / kRimRays;
  if (luminaire_) return rim_point(*luminaire_, p, around);
  return p + direction_to_sun(*sun_, kRim, around) * (4 * problem_->rays.diameter());
}

LightSeen SharpLight::seen(const Vec3& p, const Vec3& n) const {
  if (luminaire_ && opening_rays(*luminaire_, p) == 1) return sees_centre(p, n) ? LightSeen::all : LightSeen::none;
  const double lift = problem_->rays.lift();
  const Vec3 from = p + n * lift;
  SegmentPacket packet;
  for (int k = 0; k < kRimRays; ++k) {
    const Vec3 to = rim(from, k);
    packet.set(k, from, luminaire_ ? short_of(to, from, lift) : to);
  }
  const std::uint16_t free = problem_->rays.visible16(packet);
  return free == 0 ? LightSeen::none : free == 0xffff ? LightSeen::all : LightSeen::part;
}

std::vector<SharpLight> sharp_lights(const Problem& problem) {
  std::vector<SharpLight> lights;
  for (const PlacedSun& sun : problem.lights.suns)
    if (sun.mirror == kNoMirror) lights.emplace_back(problem, sun);
  for (const PlacedLuminaire& luminaire : problem.lights.luminaires)
    if (luminaire.mirror == kNoMirror) lights.emplace_back(problem, luminaire);
  return lights;
}

}  // namespace clerestory
