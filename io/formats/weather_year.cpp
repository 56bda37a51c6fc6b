#include "io/formats/weather_year.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "io/formats/weather_light.h"
#include "io/odd_place.h"
#include "io/text.h"
#include "solver/model/annual.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

using HoursByTime = std::array<const WeatherHour*, kHoursOfYear>;

constexpr std::array<int, 12> kDaysOfMonth = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};

bool is_leap_day(const WeatherHour& h) { return h.month == 2 && h.day == 29; }

/// In a year of 365 days; nothing for a date that does not exist.
std::optional<std::size_t> hour_of_year(const WeatherHour& h) {
  if (h.month < 1 || h.hour < 1 || h.day > kDaysOfMonth[static_cast<std::size_t>(h.month - 1)]) return std::nullopt;
  int days = h.day - 1;
  for (int month = 1; month < h.month; ++month) days += kDaysOfMonth[static_cast<std::size_t>(month - 1)];
  return static_cast<std::size_t>(days * 24 + h.hour - 1);
}

std::string date_of(const WeatherHour& h) { return text("hour ", h.hour, " of ", h.month, "/", h.day); }

/// By hour of the year; null where the file has none.
HoursByTime hours_by_time(const Weather& weather, std::vector<std::string>& warnings) {
  HoursByTime by_time{};
  const WeatherHour* leap_day = nullptr;
  for (const WeatherHour& h : weather.hours) {
    if (is_leap_day(h) && !leap_day) leap_day = &h;
    const std::optional<std::size_t> i = hour_of_year(h);
    if (!i) continue;
    if (const WeatherHour* first = by_time[*i]) {
      throw InputError(text(weather.file, ":", h.line, ": has ", date_of(h), " (month/day) again, after line ",
                            first->line, "; figures of a year are of one year: cut the file to 8760 hours"));
    }
    by_time[*i] = &h;
  }
  if (leap_day) {
    warnings.push_back(
        text(weather.file, ":", leap_day->line, ": 29 February is left out; figures of a year are of 8760 hours"));
  }
  return by_time;
}

/// The middle of hour i's part with the sun up, in the year of the file's row or any.
Moment moment_of(std::size_t i, const WeatherHour* row, const Place& place) {
  Moment moment;
  int day = static_cast<int>(i / 24);
  std::size_t month = 0;
  for (; day >= kDaysOfMonth[month]; ++month) day -= kDaysOfMonth[month];
  moment.month = static_cast<int>(month) + 1;
  moment.day = day + 1;
  if (row) moment.year = row->year;
  moment.hour = middle_of_daylight(place, moment, static_cast<int>(i % 24) + 1);
  return moment;
}

/// Hours that something was found of, and what the first of them has.
struct Found {
  int count = 0;
  std::string first;

  void add(const std::string& what) {
    if (count++ == 0) first = what;
  }
};

/// Great-circle distance [km].
double distance_km(const Place& a, const Place& b) {
  constexpr double kDegree = std::numbers::pi / 180, kEarthRadius = 6371;
  const auto direction = [](const Place& p) {
    const double latitude = p.latitude_deg * kDegree, longitude = p.longitude_deg * kDegree;
    return Vec3{std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude), std::sin(latitude)};
  };
  const Vec3 u = direction(a), v = direction(b);
  return kEarthRadius * std::atan2(length(cross(u, v)), dot(u, v));
}

/// Weather of elsewhere is taken all the same: there may be none nearer.
void warn_of_distance(const Weather& weather, const Place& place, std::vector<std::string>& warnings) {
  constexpr double kFar = 100;  // [km]
  const double km = distance_km(weather.place, place);
  if (km <= kFar) return;
  warnings.push_back(text(weather.file, ": is of ", weather.city, ", ", std::round(km),
                          " km from the scene's location, where the sun is computed for"));
}

/// Direct light [lx h] of the year, facing the sun, and of its hours in which the sun is down all the time.
struct DirectLight {
  double all = 0, by_night = 0;
  int nights = 0;

  void add(double lux, bool is_night) {
    all += lux;
    if (is_night && lux > 0) by_night += lux, ++nights;
  }
};

/// A place, a time zone or hours of another convention move the sun against its light.
void warn_of_night_sun(const Weather& weather, const DirectLight& direct, std::vector<std::string>& warnings) {
  constexpr double kMuch = 0.01;
  if (!(direct.by_night > kMuch * direct.all)) return;
  warnings.push_back(text(weather.file, ": ", direct.nights, " hours have direct light while the sun is down, ",
                          std::round(1000 * direct.by_night / direct.all) / 10,
                          " % of the year's; it is left out. Are the location, and its timezone, those of the file?"));
}

void refuse_missing(const Weather& weather, const Found& missing, int sunny_hours) {
  if (missing.count == sunny_hours || (sunny_hours > 0 && missing.count > kMostMissing * sunny_hours)) {
    throw InputError(text(
        weather.file, ": ", missing.count, " of the ", sunny_hours,
        " hours of the year with the sun up have no radiation, direct normal and diffuse horizontal; at most ",
        100 * kMostMissing, " % of them may be missing. The first: ", missing.first, "; take another weather file"));
  }
}

}  // namespace

DaylightYear daylight_year(const Weather& weather, const Place& place, double north_deg, double ground_reflectance) {
  DaylightYear year{weather.file, weather.city, place, north_deg, {}, 0, weather.warnings};
  warn_of_place(weather.file, place, year.warnings);
  warn_of_distance(weather, place, year.warnings);
  const HoursByTime by_time = hours_by_time(weather, year.warnings);
  Found missing, derived;
  DirectLight direct;
  int sunny_hours = 0;
  for (std::size_t i = 0; i < kHoursOfYear; ++i) {
    const WeatherHour* const row = by_time[i];
    const Moment moment = moment_of(i, row, place);
    const Horizontal stands = sun_position(place, moment);
    const bool is_night = stands.elevation_deg <= 0;
    sunny_hours += !is_night;
    if (!row || !missing_radiation(*row, is_night).empty()) {
      if (!is_night) {
        missing.add(row ? text("line ", row->line, ", ", missing_radiation(*row, is_night))
                        : text("hour ", i % 24 + 1, " of ", moment.month, "/", moment.day, " (month/day) has no line"));
      }
      continue;
    }
    HourOfDaylight light = daylight_of(*row);
    if (light.direct_normal == 0 && light.diffuse_horizontal == 0) continue;
    const Vec3 to_sun = scene_direction(stands, north_deg);
    const SkyMeasurement measured = measurement_of(light, to_sun, day_of_year(moment));
    if (const std::string why = add_illuminances(light, measured); !why.empty())
      derived.add(text(row->line, ": ", why));
    direct.add(*light.direct_normal_lux, is_night);
    if (is_night) light.direct_normal_lux = 0;
    if (!(*light.direct_normal_lux > 0) && !(*light.diffuse_horizontal_lux > 0)) continue;
    Sky sky{.model = SkyModel::perez,
            .horizontal_irradiance = Spectrum(*light.diffuse_horizontal_lux / kWhiteEfficacy),
            .ground_reflectance = ground_reflectance,
            .shape = perez_shape(measured),
            .sun = to_sun};
    year.hours.push_back({.hour = static_cast<int>(i),
                          .moment = moment,
                          .sun = to_sun,
                          .sun_up = !is_night,
                          .sun_normal_irradiance = *light.direct_normal_lux / kWhiteEfficacy,
                          .sky = std::move(sky),
                          .diffuse_horizontal_lux = *light.diffuse_horizontal_lux});
  }
  refuse_missing(weather, missing, sunny_hours);
  warn_of_night_sun(weather, direct, year.warnings);
  if (year.hours.empty())
    throw InputError(text(weather.file, ": its radiation is 0 in all hours; take another weather file"));
  year.missing_hours = missing.count;
  if (missing.count > 0) {
    year.warnings.push_back(
        text(weather.file, ": ", missing.count, " of the ", sunny_hours,
             " hours with the sun up have no radiation and count as dark. The first: ", missing.first));
  }
  if (derived.count > 0) {
    year.warnings.push_back(text(weather.file, ":", derived.first, kDerivedFromRadiation,
                                 derived.count > 1 ? text(", as in ", derived.count - 1, " more hours") : ""));
  }
  return year;
}

}  // namespace clerestory
