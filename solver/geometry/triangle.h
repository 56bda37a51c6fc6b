#pragma once
// Points and triangles.

#include <array>

#include "solver/model/vec.h"

namespace clerestory {

/// Point of a triangle that is nearest to p. Source: Ericson, "Real-time collision detection", 2005, 5.1.5.
Vec3 nearest_point(const std::array<Vec3, 3>& triangle, const Vec3& p);

}  // namespace clerestory
