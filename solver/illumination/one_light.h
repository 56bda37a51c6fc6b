#pragma once
// Luminaires and suns, images among them, by one number each: that of Layer::lights.

#include <cstdint>

#include "solver/illumination/problem.h"
#include "solver/lights/light_choice.h"

namespace clerestory {

/// Luminaires count by what is left of their light on the way.
LightChoice choice_of_lights(const Problem& problem);

bool is_sun(const Lights& lights, std::uint32_t light);
const PlacedSun& sun_of(const Lights& lights, std::uint32_t light);

/// Where its light comes from, u and v in [0, 1): of a luminaire a place of its opening, whoever asks from however far;
/// of a sun the direction (unit) to a point of the disc.
Vec3 point_of_light(const Lights& lights, std::uint32_t light, double u, double v);

struct LightFromPoint {
  Vec3 direction;            ///< unit, to the light
  Spectrum irradiance{0.0};  ///< what arrives, over mirrors of an image, of what the light sends from there [W/m2]
};
/// At the place x (lifted) of a surface with unit normal n.
LightFromPoint light_from_point(const Problem& problem, std::uint32_t light, const Vec3& point, const Vec3& x,
                                const Vec3& n);

}  // namespace clerestory
