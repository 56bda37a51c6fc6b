#pragma once
// What is told of a year of daylight: the limits of the standards, and the figures of a point, a room or a grid.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace clerestory {

inline constexpr std::size_t kHoursOfYear = 8760;
inline constexpr std::size_t kDaylightHours = 4380;   ///< of EN 17037: half of the year
inline constexpr double kUsefulLux[2] = {100, 3000};  ///< UDI: useful from the one to the other, both included
inline constexpr double kSunLux = 1000;               ///< ASE: above it; blinds: from it on
inline constexpr int kSunHours = 250;                 ///< of ASE
inline constexpr std::array<double, 4> kEn17037Lux = {100, 300, 500, 750};
inline constexpr std::size_t kMostThresholds = 4;  ///< besides that of daylight autonomy

enum class En17037Level { none, minimum, medium, high };
/// In the order of the enumerators.
inline constexpr const char* kEn17037LevelNames[] = {"none", "minimum", "medium", "high"};

/// One point in hours, of which each figure is a share. low and high: what it would be if all illuminances were wrong
/// by their error, down or up.
struct PointYear {
  std::uint16_t DA = 0, DA_low = 0, DA_high = 0;            ///< occupied hours with E >= threshold
  std::uint16_t UDI_lit = 0, UDI_upper = 0;                 ///< occupied hours with E >= 100 and E > 3000 lx
  std::uint16_t ASE = 0, ASE_low = 0, ASE_high = 0;         ///< occupied hours with more than 1000 lx of direct sun
  std::array<std::uint16_t, kEn17037Lux.size()> EN17037{};  ///< daylight hours with E >= 100, 300, 500, 750 lx
  std::array<std::uint16_t, kMostThresholds> at_least{};    ///< occupied hours with E >= further thresholds
  double cDA = 0;                                           ///< sum of min(1, E / threshold) over occupied hours [h]
  double lux_hours = 0;                                     ///< sum of E over occupied hours [lx h]
};

/// A share of area [%], and where it lies under the errors of the illuminances.
struct ShareWithin {
  double value = 0, low = 0, high = 0;
};

/// Whether a share [%] is so large. Sums of areas are rounded: twenty times a twentieth is the whole.
constexpr bool reaches_share(double share, double least) { return share >= least - 1e-9; }

/// From each of these sDA 300/50 % on LEED v4.1 gives a point more.
inline constexpr std::array<double, 3> kLeedShares = {40, 55, 75};
constexpr int leed_points(double sDA) {
  int points = 0;
  for (const double share : kLeedShares) points += reaches_share(sDA, share);
  return points;
}
inline constexpr double kLeedAse = 10;  ///< an ASE above it is to be explained in writing [%]

/// A room or a grid.
struct AreaYear {
  double area = 0;            ///< [m2]; the number of points where their areas are not known
  ShareWithin sDA;            ///< area with DA >= 50 %
  ShareWithin ASE_more_than;  ///< area with direct sun in more than 250 hours
  ShareWithin ASE_at_least;   ///< area with direct sun in 250 hours or more
  /// Of minimum, medium and high: area that has the target, and the minimum illuminance, in half of the daylight hours.
  std::array<double, 3> target_share{}, minimum_share{};  ///< [%]
  En17037Level level = En17037Level::none;                ///< the highest with the target on 50 %, the minimum on 95 %
  double mean = 0;                                        ///< over area and occupied hours [lx]
};

/// Blinds of a room, over the occupied hours of a year.
struct BlindsYear {
  int hours_closed = 0;         ///< in which any blinds are closed
  int hours_not_complying = 0;  ///< in which more than 2 % of the points have sun whatever is closed
};

/// Relative errors of illuminances, >= 0. From 1 on nothing is sure to be lit.
struct YearError {
  double total = 0, direct = 0;
};

/// What a report tells of a room or a grid.
struct AreaOfYear {
  std::string name;
  std::size_t points = 0;
  AreaYear year;
  BlindsYear blinds;
  bool has_area = true;  ///< the areas that its points stand for are known
};

/// What the figures of a year were made with, and of.
struct AnnualReport {
  std::string scene, weather, city;  ///< names of files, and of the place
  double latitude_deg = 0, longitude_deg = 0, timezone = 0;
  std::string schedule;                ///< as it was asked for, "8-18"
  int occupied_hours = 0;              ///< of the year
  int lit_hours = 0;                   ///< with light outdoors
  int missing_hours = 0;               ///< of the weather file, taken as dark
  double threshold = 300;              ///< of DA, cDA and sDA [lx]
  bool blinds_operated = false;        ///< the model has blinds, and sDA and the others but ASE are with them
  YearError error_rooms, error_grids;  ///< that the intervals go by
  std::vector<AreaOfYear> rooms, grids;
};

}  // namespace clerestory
