#pragma once
// Weather of a typical year by the hour, as EnergyPlus files (.epw) hold it.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "solver/model/solar_position.h"

namespace clerestory {

/// Means over one hour. Empty: the file marks the value as missing, or holds nothing of use there.
struct WeatherHour {
  int year = 2001, month = 0, day = 0;  ///< month 0: its date cannot be read
  int hour = 0;                         ///< 1 to 24, local standard time: the hour that ends then, 12 is 11:00 to 12:00
  int line = 0;                         ///< of the file
  std::optional<double> direct_normal, diffuse_horizontal;          ///< [W/m2]
  std::optional<double> direct_normal_lux, diffuse_horizontal_lux;  ///< [lx]
  std::optional<double> dew_point_c;                                ///< [degrees C]
  std::optional<double> precipitable_water_cm;                      ///< [cm]
  std::string flaw;  ///< what is wrong with its date or radiation, where it is not just missing
};

struct Weather {
  std::string file, city;
  Place place;
  std::vector<WeatherHour> hours;
  std::vector<std::string> warnings;  ///< what was assumed, beginning with the file's name

  /// Of the year, where the file has that; else the first one of that date.
  ///
  /// throws  InputError when the file has no such hour.
  const WeatherHour& at(int month, int day, int hour, std::optional<int> year = {}) const;
};

/// Reads what a whole file must have, and of each hour what can be read: one bad hour is no reason against another.
/// Commas separate, or what stands behind LOCATION: semicolons or tabs, with decimal commas perhaps. Cells may be
/// quoted. Small negative radiation, the night's offset of a pyranometer, counts as 0; blanks, fillers of nines and
/// other negatives as missing.
///
/// throws  InputError naming file and line: no EPW, no place, more than one record an hour, fewer hours than the header
///         says.
Weather read_epw(const std::filesystem::path& file);

}  // namespace clerestory
