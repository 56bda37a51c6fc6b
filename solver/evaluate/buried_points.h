#pragma once
// Sensors that no room holds.

#include <cstddef>
#include <span>
#include <vector>

#include "solver/illumination/problem.h"
#include "solver/model/sensors.h"

namespace clerestory {

/// Numbers of the points that lie inside a solid, ascending.
///
/// A solid and a dark room are alike in that no light reaches the sides around the point. A solid shows backs there:
/// its faces are wound outwards; unless what is around is several surfaces that a room has space in (1.5 m each way), a
/// room that was wound outwards. Where fronts are seen, what is too narrow for a room (0.5 m) counts as a solid, and
/// what is low for one (1.5 m) and stands in the light with most of its sides. Cost: 32 rays a point, and 64 more for
/// those in the dark.
std::vector<std::size_t> buried_points(const Problem& problem, std::span<const SensorPoint> points);

}  // namespace clerestory
