#include "solver/model/solar_position.h"

#include <chrono>
#include <cmath>
#include <numbers>

namespace clerestory {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::chrono::sys_days date_of(const Moment& m) {
  using namespace std::chrono;
  return year_month_day(year(m.year), month(static_cast<unsigned>(m.month)), day(static_cast<unsigned>(m.day)));
}

/// Days since noon of 1 January 2000, universal time.
double days_since_2000(const Place& place, const Moment& m) {
  using namespace std::chrono;
  constexpr sys_days kEpoch = year_month_day(year(2000), January, day(1));
  return (date_of(m) - kEpoch).count() + (m.hour - place.timezone - 12) / 24;
}

}  // namespace

int day_of_year(const Moment& m) {
  using namespace std::chrono;
  return static_cast<int>((date_of(m) - sys_days(year_month_day(year(m.year), January, day(1)))).count()) + 1;
}

Horizontal sun_without_air(const Place& place, const Moment& moment) {
  const double days = days_since_2000(place, moment);
  const double T = days / 36525;  // Julian centuries

  // Where the sun stands on the ecliptic.
  const double mean_longitude = 280.46646 + T * (36000.76983 + T * 0.0003032);
  const double M = (357.52911 + T * (35999.05029 - T * 0.0001537)) * kDegree;
  const double centre = (1.914602 - T * (0.004817 + T * 0.000014)) * std::sin(M) +
                        (0.019993 - T * 0.000101) * std::sin(2 * M) + 0.000289 * std::sin(3 * M);
  const double node = (125.04 - 1934.136 * T) * kDegree;  // of the moon: nutation follows it
  const double nutation = -0.00478 * std::sin(node), aberration = -0.00569;
  const double longitude = (mean_longitude + centre + aberration + nutation) * kDegree;
  const double obliquity = (23.439291 - 0.0130042 * T + 0.00256 * std::cos(node)) * kDegree;

  // On the sky's equator, and as the turning Earth sees it.
  const double right_ascension = std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
  const double sidereal_deg =
      280.46061837 + std::fmod(360.98564736629 * days, 360.0) + 0.000387933 * T * T + nutation * std::cos(obliquity);
  const double hour_angle = (sidereal_deg + place.longitude_deg) * kDegree - right_ascension;
  const double latitude = place.latitude_deg * kDegree;
  const double up =
      std::sin(latitude) * std::sin(declination) + std::cos(latitude) * std::cos(declination) * std::cos(hour_angle);
  const double east = -std::cos(declination) * std::sin(hour_angle);
  const double north =
      std::cos(latitude) * std::sin(declination) - std::sin(latitude) * std::cos(declination) * std::cos(hour_angle);

  constexpr double kParallax = 8.794 / 3600;  // [degrees], for a sun on the horizon
  const double flat = std::hypot(east, north);
  const double azimuth = std::atan2(east, north) / kDegree;
  return {std::atan2(up, flat) / kDegree - kParallax * flat, azimuth < 0 ? azimuth + 360 : azimuth};
}

double refraction_deg(double e, double pressure_hPa, double temperature_c) {
  constexpr double kSunRadius = 0.26667, kAtHorizon = 0.5667;
  if (e < -(kSunRadius + kAtHorizon)) return 0;
  return pressure_hPa / 1010 * 283 / (273 + temperature_c) * 1.02 / (60 * std::tan((e + 10.3 / (e + 5.11)) * kDegree));
}

Horizontal sun_position(const Place& place, const Moment& moment) {
  Horizontal sun = sun_without_air(place, moment);
  sun.elevation_deg += refraction_deg(sun.elevation_deg);
  return sun;
}

Vec3 scene_direction(const Horizontal& direction, double north_deg) {
  const double e = direction.elevation_deg * kDegree, a = (direction.azimuth_deg + north_deg) * kDegree;
  return {std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)};
}

Horizontal compass_direction(const Vec3& direction, double north_deg) {
  const double across = std::hypot(direction.x, direction.y);
  const double azimuth = across > 0 ? std::atan2(direction.x, direction.y) / kDegree - north_deg : 0;
  const double turned = azimuth - 360 * std::floor(azimuth / 360);
  return {std::atan2(direction.z, across) / kDegree, turned < 360 ? turned : 0};  // rounding may give 360
}

}  // namespace clerestory
