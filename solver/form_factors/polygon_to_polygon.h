#pragma once
// Unoccluded exchange between two planar polygons, to the last digits that matter.

#include <span>

#include "solver/model/vec.h"

namespace clerestory {

/// Form factor F12 [1] between two simple planar polygons with nothing in between: the part of the flux leaving the
/// front of polygon 1 that arrives at the front of polygon 2. Corners counter-clockwise around the front; convex or
/// not; each is clipped by the other's plane first. Zero when either has no area or they do not face each other.
///
/// Relative error below 1e-6 for touching (shared edges of 0.1 to 179 degrees), sliver (1:1000), grazing, near
/// (gap / size 1e-4) and far (1e4) pairs, at any scale; mostly below 1e-10. Slivers both grazing and touching keep the
/// contour's rounding, about 1e-15 size^2 of exchange area. Cost: 10 to 50 us for near triangles, up to 20 ms for the
/// few pairs whose contour rounding spoils.
///
/// Near pairs by the contour integral over both rims, far ones by Gauss quadrature over both areas, because the
/// contour's terms cancel like (size / distance)^2. See contour_exchange.h for the sources.
double polygon_to_polygon(std::span<const Vec3> polygon1, std::span<const Vec3> polygon2);

/// The same as exchange area A1 F12 = A2 F21 [m2], which does not change when the polygons are swapped.
double exchange_area(std::span<const Vec3> polygon1, std::span<const Vec3> polygon2);

}  // namespace clerestory
