#pragma once
// How wrong the illuminances of single hours are, measured against paths under the light of these hours.

#include <span>

#include "pipeline/annual/solve_year.h"
#include "pipeline/annual/window_state.h"

namespace clerestory {

/// At an even choice of sensors, and of the points of rooms, in hours chosen evenly by how bright they are. Fills
/// error_sensors and error_points, and what figures go by: of all light where there is a third of the threshold at
/// least, relative to the point's own value; of direct sun the same where there is a third of kSunLux. Both are upper
/// ends of their 95 % intervals; 0 where nothing is so bright. With
/// blinds open.
void measure_year_error(const WindowState& open, const Prepared& scene, std::span<const PlacesOfPoint> points,
                        const GatherPattern& of_points, std::span<const PlacesOfPoint> sensors,
                        const GatherPattern& of_sensors, std::span<const DaylightHour> hours, const SolveOptions& solve,
                        const Monitor& monitor, YearSolved& out);

}  // namespace clerestory
