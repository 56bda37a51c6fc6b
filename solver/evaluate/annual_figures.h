#pragma once
// What daylight standards ask of a year of hours, at a point and of an area.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "solver/model/annual.h"

namespace clerestory {

/// Which hours count, and of how many. Light is given for H hours of the year; all others are dark, and stay in the
/// divisors.
struct YearRules {
  std::vector<float> occupied, daylight;  ///< H each, 1 for hours that count and 0 for others
  int occupied_hours = 0;                 ///< of the whole year, at least one
  double threshold = 300;                 ///< of DA, cDA and sDA [lx], > 0
  std::vector<double> more_thresholds;    ///< whose hours are counted too [lx], > 0, at most kMostThresholds
};

/// hours       of the year, H, ascending: hour h goes from h to h + 1, [0, 8760).
/// diffuse     horizontal illuminance outdoors in these hours [lx]; the 4,380 hours that have most of it are the
///             daylight hours of EN 17037, of equal ones the earlier.
/// is_occupied by hour of the year, 8,760.
YearRules year_rules(std::span<const int> hours, std::span<const double> diffuse,
                     std::span<const std::uint8_t> is_occupied, double threshold = 300,
                     std::vector<double> more_thresholds = {});

/// total, direct  illuminance of all light, and of direct sun with blinds open, by hour [lx], H each; direct may be
///                empty: no sun comes here.
/// Thread safe; allocates nothing. 1.4 ns an hour.
PointYear figures_of(std::span<const float> total, std::span<const float> direct, const YearRules& rules,
                     const YearError& error = {});

/// A threshold in the name of a figure, in lux to six decimals: "300", "437.5".
std::string threshold_name(double lux);

/// A figure as files have it.
struct YearFigure {
  std::string name;  ///< "DA_300"
  std::string unit;  ///< "%", "h", "lx"
  double (*value)(const PointYear&, const YearRules&, std::size_t index) = nullptr;
  std::size_t index = 0;  ///< for `value`

  double operator()(const PointYear& point, const YearRules& rules) const { return value(point, rules, index); }
};

/// DA_300, cDA_300, UDI_lower, UDI, UDI_upper, ASE_hours, mean_illuminance, EN17037_100, _300, _500, _750, then
/// hours_LUX for each of more_thresholds. DA and cDA are named by the threshold.
std::vector<YearFigure> year_figures(const YearRules& rules);

/// weight  area that each point stands for, >= 0; their sum > 0.
AreaYear area_year(std::span<const PointYear> points, std::span<const double> weight, const YearRules& rules);

}  // namespace clerestory
