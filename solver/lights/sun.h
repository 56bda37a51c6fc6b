#pragma once
// Directions to points of the sun's disc.

#include "solver/model/light_spec.h"

namespace clerestory {

inline constexpr double kSunDiameterDeg = 0.533;  ///< mean angular diameter seen from the Earth

/// Unit direction to a point of the disc, uniform over its solid angle for u, v uniform in [0, 1).
Vec3 direction_to_sun(const Sun& sun, double u, double v);
/// Density of that at direction d to the disc [1/sr].
double density_in_disc(const Sun& sun, const Vec3& d);

}  // namespace clerestory
