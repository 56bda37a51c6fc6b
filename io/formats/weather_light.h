#pragma once
// The light of one hour of a weather file: when it stands for, and what radiation and illuminance make of sky and sun.

#include <optional>
#include <string>
#include <string_view>

#include "io/formats/epw.h"
#include "solver/model/light_spec.h"
#include "solver/model/perez.h"

namespace clerestory {

/// One hour of a weather file, or what a scene gives in its place.
struct HourOfDaylight {
  double direct_normal = 0, diffuse_horizontal = 0;                 ///< [W/m2]
  std::optional<double> direct_normal_lux, diffuse_horizontal_lux;  ///< measured [lx]
  double precipitable_water = 2;                                    ///< [cm]
};

/// Middle of the part of an hour in which the sun is up, or of the hour [hours since midnight]. The values of a weather
/// file are means over the hour; at sunrise and sunset its middle may be night.
double middle_of_daylight(const Place& place, Moment moment, int hour_end);

/// What radiation an hour lacks, for a message; empty: it has all that is needed, as dark hours always have.
std::string missing_radiation(const WeatherHour& hour, bool is_night);

/// What is missing counts as 0.
HourOfDaylight daylight_of(const WeatherHour& hour);

/// to_sun   unit, in a frame with z up.
/// day      of the year, for the Earth's distance from the sun.
SkyMeasurement measurement_of(const HourOfDaylight& light, const Vec3& to_sun, std::optional<int> day);

/// Illuminances [lx] of sun and sky: measured, or by Perez' efficacies where there are none or nonsense.
///
/// returns  why they are derived, "has no illuminances for this hour; they"; empty where nothing was.
std::string add_illuminances(HourOfDaylight& light, const SkyMeasurement& measured);

/// How a warning goes on after what add_illuminances() returns.
inline constexpr std::string_view kDerivedFromRadiation =
    " are derived from its radiation by the efficacies of Perez (1990)";

}  // namespace clerestory
