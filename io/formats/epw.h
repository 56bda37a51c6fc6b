#pragma once
// Weather of a typical year by the hour, as EnergyPlus files (.epw) hold it.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "solver/model/solar_position.h"

namespace clerestory {

/// Means over one hour. Empty: the file marks the value as missing.
struct WeatherHour {
  int year = 0, month = 0, day = 0;
  int hour = 0;  ///< 1 to 24, local standard time: the hour that ends then, so 12 is 11:00 to 12:00
  int line = 0;  ///< of the file
  std::optional<double> direct_normal, diffuse_horizontal;          ///< [W/m2]
  std::optional<double> direct_normal_lux, diffuse_horizontal_lux;  ///< [lx]
  std::optional<double> dew_point_c;                                ///< [degrees C]
  std::optional<double> precipitable_water_cm;                      ///< [cm]
};

struct Weather {
  std::string file, city;
  Place place;
  std::vector<WeatherHour> hours;

  /// throws  InputError when the file has no such hour.
  const WeatherHour& at(int month, int day, int hour) const;
};

/// throws  InputError naming file and line: no EPW, a row too short, a value that is no number or out of range, more
///         than one record an hour, not as many hours as the header says.
Weather read_epw(const std::filesystem::path& file);

}  // namespace clerestory
