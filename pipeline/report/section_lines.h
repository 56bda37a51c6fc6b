#pragma once
// Where a plane cuts triangles.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

/// Lines in the plane through `origin` with unit `normal`, joined where they go on, without the points that lie on a
/// straight way between others. Triangles that lie in the plane have none.
std::vector<std::vector<Vec3>> section_lines(std::span<const Vec3> points,
                                             std::span<const std::array<std::uint32_t, 3>> triangles,
                                             const Vec3& origin, const Vec3& normal);

}  // namespace clerestory
