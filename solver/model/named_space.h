#pragma once
// Rooms as a model names them: volumes that nobody draws, for grids and reports.

#include <cstdint>
#include <string>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

struct NamedSpace {
  std::string name, long_name;
  std::vector<Vec3> vertices;         ///< [m]
  std::vector<std::uint32_t> corner;  ///< three a triangle, of a closed volume; empty when the model gives none

  bool has_volume() const { return !corner.empty(); }
};

/// A room by the surfaces that are in it, all or some of them.
struct NamedSurfaces {
  std::string name;
  std::vector<bool> has_surface;  ///< by SurfaceId
};

/// Area in plan [m2]: half of what all faces show from above and below.
double floor_area(const NamedSpace& space);
/// [m3] of what faces close in, whichever way they are wound. Cost: O(n^2) in n triangles, up to 3,000; more are taken
/// to be wound one way, O(n).
double volume(const NamedSpace& space);
/// From the lowest to the highest point [m].
double height(const NamedSpace& space);

/// A storey of a space above one point in plan.
struct SpaceSpan {
  double floor = 0, ceiling = 0;  ///< z [m]
};
/// Where the vertical line through (x, y) is inside, from below; a line through an edge counts to one side of it.
std::vector<SpaceSpan> spans_at(const NamedSpace& space, double x, double y);

/// Unit horizontal direction of the longest level edge: the way that a room's walls go. +x where there is none.
Vec3 wall_direction(const NamedSpace& space);

}  // namespace clerestory
