#pragma once
// How far two surfaces are apart.

#include <array>
#include <optional>
#include <span>

#include "solver/model/vec.h"

namespace clerestory {

using TriangleCorners = std::array<Vec3, 3>;

/// No point of `from` is farther from `to` than what is returned, which is at most `most`; none when that cannot be
/// shown. It is within a quarter of `most` of the true distance, where 24 halvings of a triangle are enough for that.
std::optional<double> farthest_distance(std::span<const TriangleCorners> from, std::span<const TriangleCorners> to,
                                        double most);

}  // namespace clerestory
