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

/// H hours in which there is light. Radiances are white [W/(m2 sr)], irradiances [W/m2].
struct YearLight {
  std::size_t hours = 0, stride = 0;  ///< H, and how far rows are apart: H and a little, which is dark
  std::vector<float> fine;            ///< (parts + 1) x stride: radiance of each fine part, then of the ground
  std::vector<float> coarse;          ///< the same of the coarse parts
  std::vector<float> sun;             ///< H, irradiance of a plane that faces the sun
  std::vector<AmongNodes> of_sun;     ///< H
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
