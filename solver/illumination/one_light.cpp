#include "solver/illumination/one_light.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "solver/lights/luminaire.h"
#include "solver/lights/near_planes.h"
#include "solver/lights/sun.h"
#include "solver/model/units.h"

namespace clerestory {

LightChoice choice_of_lights(const Problem& problem) {
  std::vector<LightBounds> luminaires;
  for (const PlacedLuminaire& luminaire : problem.lights.luminaires) {
    luminaires.push_back(bounds(luminaire));
    luminaires.back().power *= luminaire.share;
  }
  std::vector<LightChoice::Sun> suns;
  for (const PlacedSun& sun : problem.lights.suns)
    suns.push_back({sun.direction, sun.share * luminous_mean(sun.normal_irradiance)});
  return {luminaires, std::move(suns), problem.rays.diameter()};
}

bool is_sun(const Lights& lights, std::uint32_t light) { return light >= lights.luminaires.size(); }
const PlacedSun& sun_of(const Lights& lights, std::uint32_t light) {
  return lights.suns[light - lights.luminaires.size()];
}

Vec3 point_of_light(const Lights& lights, std::uint32_t light, double u, double v) {
  if (is_sun(lights, light)) return direction_to_sun(sun_of(lights, light), u, v);
  const PlacedLuminaire& luminaire = lights.luminaires[light];
  return light_point(luminaire, luminaire.position, u, v);
}

LightFromPoint light_from_point(const Problem& problem, std::uint32_t light, const Vec3& point, const Vec3& x,
                                const Vec3& n) {
  const Lights& lights = problem.lights;
  const RayScene& rays = problem.rays;
  const auto over = [&](const Vec3& from, const Vec3& to, const MirrorWay& way) {
    return way.empty() ? rays.transmittance(from, to) : rays.transmittance_by_mirrors(from, to, way);
  };
  if (is_sun(lights, light)) {
    const PlacedSun& sun = sun_of(lights, light);
    const double cosine = dot(n, point);
    if (!(cosine > 0) || sun.normal_irradiance.is_black()) return {point};
    return {point, sun.normal_irradiance * cosine * over(x, x + point * (4 * rays.diameter()), sun.way)};
  }
  const PlacedLuminaire& luminaire = lights.luminaires[light];
  LightFromPoint found{normalized(point - x), open_irradiance(luminaire, point, x, n)};
  if (found.irradiance.is_black()) return found;
  if (const ShadowSegment way = shadow_segment(luminaire, point, x); !way.is_free)
    found.irradiance *= over(way.from, way.to, luminaire.way);
  return found;
}

}  // namespace clerestory
