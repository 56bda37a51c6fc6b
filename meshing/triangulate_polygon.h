#pragma once
// One polygon -> triangles.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

/// Area vector of a polygon by Newell's sum: its length is the area [m2], its direction the front's normal.
Vec3 area_vector(std::span<const Vec3> polygon);

struct PolygonTriangles {
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of corners, wound like the polygon
  std::vector<Vec3> crossings;                          ///< corners beyond the polygon's own: where it crosses itself
  bool gave_up = false;                                 ///< it crosses itself too often; there is nothing else then
};

/// Triangulates a polygon that may be concave, slightly out of plane, cross itself, or carry holes joined to the
/// outside by doubled edges: what lies inside is told by the parity of the edges between it and the outside.
/// Cost: O(n log n) for n corners that lie as polygons' do, and some 10 us a crossing.
PolygonTriangles triangulate_polygon(std::span<const Vec3> polygon, std::size_t most_crossings = 50'000);

}  // namespace clerestory
