#pragma once
// How large the triangles of a mesh are.

#include <cmath>

namespace clerestory {

/// A refined mesh of edges up to h has triangles of so many h2 in the mean.
inline constexpr double kMeanTriangle = 0.21;

/// The longest edge of a mesh of about so many triangles on that area.
inline double longest_edge_for(double triangles, double area) { return std::sqrt(area / (kMeanTriangle * triangles)); }

}  // namespace clerestory
