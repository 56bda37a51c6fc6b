#include "io/formats/weather_light.h"

#include <algorithm>
#include <cmath>

#include "io/text.h"

namespace clerestory {
namespace {

/// Luminous efficacies of daylight [lm/W], with room around what is measured (90 to 150). Other illuminances are in
/// klux, hundredths, fillers or nothing.
constexpr double kLeastEfficacy = 30, kMostEfficacy = 250;

/// Whether so many lux are no light of so many W/m2. Files round to 1 W/m2 and 100 lx.
bool is_no_daylight(const std::optional<double>& lux, double irradiance) {
  return lux && *lux > 0 &&
         (*lux < kLeastEfficacy * (irradiance - 1) - 100 || *lux > kMostEfficacy * (irradiance + 1) + 100);
}

}  // namespace

double middle_of_daylight(const Place& place, Moment moment, int hour_end) {
  constexpr int kSteps = 60;
  double sum = 0;
  int lit = 0;
  for (int k = 0; k < kSteps; ++k) {
    moment.hour = hour_end - 1 + (k + 0.5) / kSteps;
    if (sun_position(place, moment).elevation_deg > 0) sum += moment.hour, ++lit;
  }
  return lit > 0 ? sum / lit : hour_end - 0.5;
}

std::string missing_radiation(const WeatherHour& hour, bool is_night) {
  if (is_night || (hour.direct_normal && hour.diffuse_horizontal)) return "";
  if (!hour.flaw.empty()) return hour.flaw;
  return text("the ", hour.direct_normal ? "diffuse horizontal" : "direct normal",
              " radiation of this hour is missing");
}

HourOfDaylight daylight_of(const WeatherHour& hour) {
  HourOfDaylight light;
  light.direct_normal = hour.direct_normal.value_or(0);
  light.diffuse_horizontal = hour.diffuse_horizontal.value_or(0);
  light.direct_normal_lux = hour.direct_normal_lux;
  light.diffuse_horizontal_lux = hour.diffuse_horizontal_lux;
  // Dew points are measured; the precipitable water of many files is off by a factor of ten.
  if (hour.dew_point_c)
    light.precipitable_water = precipitable_water(*hour.dew_point_c);
  else
    light.precipitable_water = hour.precipitable_water_cm.value_or(light.precipitable_water);
  return light;
}

SkyMeasurement measurement_of(const HourOfDaylight& light, const Vec3& to_sun, std::optional<int> day) {
  return {.direct_normal = light.direct_normal,
          .diffuse_horizontal = light.diffuse_horizontal,
          .zenith_angle = std::acos(std::clamp(to_sun.z, -1.0, 1.0)),
          .day_of_year = day,
          .precipitable_water = light.precipitable_water};
}

std::string add_illuminances(HourOfDaylight& light, const SkyMeasurement& measured) {
  std::string why;
  const auto check = [&](const std::optional<double>& lux, double irradiance, std::string_view name) {
    if (!why.empty() || !is_no_daylight(lux, irradiance)) return;
    why = text("its ", name, " illuminance, ", *lux, " lx for ", irradiance, " W/m2, is no daylight, which has ",
               kLeastEfficacy, " to ", kMostEfficacy, " lm/W; the illuminances of this hour");
  };
  check(light.direct_normal_lux, light.direct_normal, "direct normal");
  check(light.diffuse_horizontal_lux, light.diffuse_horizontal, "diffuse horizontal");
  if (!why.empty()) light.direct_normal_lux = light.diffuse_horizontal_lux = std::nullopt;
  const auto complete = [&](std::optional<double>& lux, double irradiance, double efficacy) {
    // Files that hold no illuminances may say 0 for them in bright daylight.
    if (lux && (*lux > 0 || irradiance == 0)) return;
    lux = irradiance * efficacy;
    if (why.empty() && irradiance > 0) why = "has no illuminances for this hour; they";
  };
  complete(light.direct_normal_lux, light.direct_normal, direct_efficacy(measured));
  complete(light.diffuse_horizontal_lux, light.diffuse_horizontal, diffuse_efficacy(measured));
  return why;
}

}  // namespace clerestory
