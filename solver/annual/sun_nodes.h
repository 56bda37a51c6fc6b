#pragma once
// Positions of the sun that reflected sunlight is solved for, and each hour's place among them.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

/// Up to four nodes around a position of the sun; weights sum to 1.
struct AmongNodes {
  std::array<std::size_t, 4> node{};
  std::array<float, 4> weight{};
};

/// Nodes of a grid over declination and hour angle, in which the sun's days are straight lines: sun patches move evenly
/// along it, and what they send on is linear between nodes.
struct SunNodes {
  std::vector<Vec3> direction;     ///< of each node that any position needs, unit, scene's frame
  std::vector<AmongNodes> of_sun;  ///< of each position
};

/// suns          unit, scene's frame, above the horizon.
/// latitude_deg  of the place; north_deg: clockwise from +y.
/// step_deg      of the grid, at most.
/// A node that the ground hides stands a degree above the horizon instead.
SunNodes place_sun_nodes(std::span<const Vec3> suns, double latitude_deg, double north_deg, double step_deg);

}  // namespace clerestory
