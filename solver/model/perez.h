#pragma once
// Perez' all-weather sky: from the irradiance of sun and sky to their light and its distribution.

#include <optional>

#include "solver/model/sky_shape.h"

namespace clerestory {

/// One sky as a weather station sees it.
struct SkyMeasurement {
  double direct_normal = 0;        ///< [W/m2], >= 0
  double diffuse_horizontal = 0;   ///< [W/m2], >= 0
  double zenith_angle = 0;         ///< of the sun [rad]; beyond the horizon it counts as on it
  std::optional<int> day_of_year;  ///< 1 to 366, for the Earth's distance from the sun; none: the mean distance
  double precipitable_water = 2;   ///< [cm]
};

/// How clear and how bright the sky is.
struct SkyCondition {
  double air_mass = 1;    ///< Kasten 1966
  double clearness = 1;   ///< epsilon, 1 (overcast) upwards
  double brightness = 0;  ///< Delta; kept within [0.01, 0.6], where the coefficients were fitted
  int bin = 0;            ///< of clearness, 0 to 7
};

/// Source: Perez, Ineichen, Seals, Michalsky & Stewart, "Modeling daylight availability and irradiance components from
/// direct and global irradiance", 1990; solar constant 1367 W/m2, distance from the sun by Spencer 1971. Under a sun
/// without diffuse light clearness is infinite; where neither shines it is 1, overcast.
SkyCondition sky_condition(const SkyMeasurement& measured);

/// Distribution of luminance. Source: Perez, Seals & Michalsky, "All-weather model for sky luminance distribution",
/// 1993. As gendaylit of Radiance does, Delta counts as 0.2 at least for clearness 1.065 to 2.8.
SkyShape perez_shape(const SkyMeasurement& measured);

/// Luminous efficacies [lm/W] of the sky's and the sun's light, >= 0. Source: Perez et al. 1990.
double diffuse_efficacy(const SkyMeasurement& measured);
double direct_efficacy(const SkyMeasurement& measured);

/// Precipitable water [cm] from the dew point [degrees C] at the ground. Source: Wright, Perez & Michalsky 1989.
double precipitable_water(double dew_point_c);

}  // namespace clerestory
