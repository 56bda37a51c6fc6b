#pragma once
// Lines of equal value on triangles. VTK stays inside.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

struct IsoLine {
  double level = 0;
  std::vector<Vec3> points;  ///< 2 or more; of a closed line the last is the first
};

/// Lines on which `value` (P, one a point, linear on triangles) is one of the levels, joined where they go on.
std::vector<IsoLine> iso_lines(std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                               std::span<const float> value, std::span<const double> levels);

}  // namespace clerestory
