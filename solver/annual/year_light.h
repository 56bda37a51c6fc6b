#pragma once
// The light of a year by the hour, and what daylight coefficients make of it.

#include <cstddef>
#include <span>
#include <vector>

#include "solver/annual/point_coefficients.h"
#include "solver/annual/sky_parts.h"
#include "solver/annual/sun_nodes.h"
#include "solver/model/daylight_year.h"

namespace clerestory {

/// Radiance of each part and of the ground by the hour, white [W/(m2 sr)]: sixteen hours of a part, then those of the
/// next, so that sums over parts read memory in a row.
class RadianceByHour {
 public:
  static constexpr std::size_t kTogether = 16;

  RadianceByHour() = default;
  RadianceByHour(std::size_t parts, std::size_t hours)
      : parts_(parts), value_((hours + kTogether - 1) / kTogether * kTogether * parts) {}
  std::size_t parts() const { return parts_; }
  float& at(std::size_t part, std::size_t hour) { return value_[index(part, hour)]; }
  float at(std::size_t part, std::size_t hour) const { return value_[index(part, hour)]; }
  /// Of sixteen hours from `hour` on, a multiple of that, those beyond the last dark: part after part.
  const float* from(std::size_t hour) const { return &value_[hour * parts_]; }

 private:
  std::size_t index(std::size_t part, std::size_t hour) const {
    return hour / kTogether * kTogether * parts_ + part * kTogether + hour % kTogether;
  }
  std::size_t parts_ = 0;
  std::vector<float> value_;
};

/// H hours in which there is light.
struct YearLight {
  std::size_t hours = 0;           ///< H
  RadianceByHour fine, coarse;     ///< parts and then the ground
  std::vector<float> sun;          ///< H, irradiance of a plane that faces the sun [W/m2]
  std::vector<AmongNodes> of_sun;  ///< H
};

/// hours  with the sun's direction where it is up; nodes.of_sun of each hour.
/// Threads: same bits for any thread count.
YearLight light_of_year(std::span<const DaylightHour> hours, const SkyParts& fine, const SkyParts& coarse,
                        const SunNodes& nodes);

/// Illuminance at points by the hour [lx].
///
/// sun     points x H, by sun_on_points().
/// total   points x H, replaced: all light. direct: the same, straight from the sun.
/// Same bits for points in any company, and on every processor.
void series_of(const YearLight& year, std::span<const PointCoefficients> points, std::span<const float> sun,
               std::span<float> total, std::span<float> direct);

}  // namespace clerestory
