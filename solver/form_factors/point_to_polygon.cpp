#include "solver/form_factors/point_to_polygon.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/geometry/polygon.h"

namespace clerestory {
namespace {

/// theta * dot(n, cross(b, a)) / |cross(b, a)| for the edge from a to b, both seen from the point.
double edge_term(const Vec3& n, const Vec3& a, const Vec3& b) {
  // cross(b - a, a) = cross(b, a), but the difference of near corners is exact where the products would cancel.
  const Vec3 b_x_a = cross(b - a, a);
  const double sin_scaled = length(b_x_a);  // |a| |b| sin(theta)
  if (sin_scaled == 0) return 0;            // the point lies on this edge's line
  // atan2 and not acos: acos loses half its digits when theta is small.
  return std::atan2(sin_scaled, dot(a, b)) * dot(b_x_a, n) / sin_scaled;
}

}  // namespace

double point_to_polygon(const Vec3& p, const Vec3& n, std::span<const Vec3> polygon) {
  if (polygon.size() < 3) return 0;
  // The polygon's front must face the point. Without this, rounding would leave noise for a point in its plane.
  const Vec3 facing = vector_area(polygon);
  if (dot(facing, p - polygon[0]) <= 0) return 0;

  double contour = 0;
  Vec3 previous, first;  // corners of the clipped contour, seen from p
  int corners = 0;
  const auto add = [&](const Vec3& x) {
    if (corners++ == 0)
      first = x;
    else
      contour += edge_term(n, previous, x);
    previous = x;
  };
  Vec3 a = polygon.back() - p;
  double height_a = dot(n, a);
  for (const Vec3& corner : polygon) {
    const Vec3 b = corner - p;
    const double height_b = dot(n, b);
    if ((height_a < 0) != (height_b < 0) && height_a != height_b) add(a + (b - a) * (height_a / (height_a - height_b)));
    if (height_b >= 0) add(b);
    a = b;
    height_a = height_b;
  }
  if (corners < 3) return 0;
  contour += edge_term(n, previous, first);
  return std::clamp(contour / (2 * std::numbers::pi), 0.0, 1.0);
}

}  // namespace clerestory
