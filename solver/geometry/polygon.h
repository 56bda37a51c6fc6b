#pragma once
// Planar polygons as lists of corners, counter-clockwise around their front.

#include <array>
#include <span>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

/// Normal of the polygon's front times its area [m2]: half the sum of cross products (Newell). Zero when degenerate.
Vec3 vector_area(std::span<const Vec3> polygon);

/// Mean of the corners, and the largest distance of a corner from it.
struct BoundingSphere {
  Vec3 centre;
  double radius = 0;
};
BoundingSphere bounding_sphere(std::span<const Vec3> polygon);

/// Half-space dot(normal, x) >= offset.
struct HalfSpace {
  Vec3 normal;  ///< unit
  double offset = 0;

  static HalfSpace through(const Vec3& point, const Vec3& unit_normal) {
    return {unit_normal, dot(unit_normal, point)};
  }
  double height(const Vec3& x) const { return dot(normal, x) - offset; }
};

/// The part of the polygon in the half-space, by Sutherland and Hodgman; empty when less than three corners are left or
/// none rises above `on_plane`, the height [m] up to which a corner counts as lying on the plane. A non-convex polygon
/// may come back with edges that run back and forth along the plane: they cancel in every contour integral.
std::vector<Vec3> clip_to_front(std::span<const Vec3> polygon, const HalfSpace& plane, double on_plane);

/// A triangle clipped by a plane has at most four corners.
struct ClippedTriangle {
  std::array<Vec3, 4> corner;
  std::size_t size = 0;

  std::span<const Vec3> corners() const { return {corner.data(), size}; }
};
ClippedTriangle clip_to_front(const std::array<Vec3, 3>& triangle, const HalfSpace& plane, double on_plane);

/// Triangles that cover a simple polygon, convex or not, by cutting ears. Corners that add no area are dropped.
std::vector<std::array<Vec3, 3>> triangulate(std::span<const Vec3> polygon);

}  // namespace clerestory
