#pragma once
// Where something ends a little off a surface: the surface gets the line.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "meshing/surface_complex.h"
#include "solver/model/material.h"

namespace clerestory {

/// A line in a plane under the outline of something that stands off it.
struct Outline {
  std::uint32_t group;
  std::array<Vec3, 2> end;
  double tolerance;
  bool above;  ///< that stands on the side of Plane::n
};

/// A wall that ends a millimetre under a slab touches it nowhere, and an element of the slab may lie on both sides of
/// the wall: it would carry light through. So the ends of surfaces are projected onto the planes that they come near,
/// for lines to be drawn there like contacts.
///
/// An edge is projected onto a plane when it is nearer than an eighth of an element and all that hangs on it leads away
/// from the plane or along it, something steeply (20 degrees) and four times as far as the edge is off; when nothing
/// lies between on both sides of it; and when it is part of an outline half an element wide. Where the end of such an
/// edge lies on a third surface, that one gets the line to the plane: it parts the surface's light as well. Planes of
/// less than a quarter of an element's area are left alone, and surfaces that rays pass.
///
/// element  longest edge of the mesh to be [working frame].
/// Threads: same result for any number. Cost: O(F log F) plus the number of edges and faces whose boxes come so near.
std::vector<Outline> find_outlines(const FaceComplex& complex, const std::vector<PlaneGroup>& groups,
                                   std::span<const Material> materials, double element);

}  // namespace clerestory
