#include "solver/form_factors/polygon_to_polygon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "solver/form_factors/contour_exchange.h"
#include "solver/form_factors/polygon.h"
#include "solver/form_factors/triangle_quadrature.h"

namespace clerestory {
namespace {

/// (r1 + r2) / distance up to which 36 x 36 Gauss points leave less than 1e-9.
constexpr double kFarRatio = 0.25;
/// Share of the contour sum that rounding may spoil before areas are integrated instead.
constexpr double kWorstRounding = 1e-9;

using Triangle = std::array<Vec3, 3>;

/// Exchange area of two triangles that lie wholly in front of each other, by Gauss quadrature, halved where they are
/// near; `budget` counts the pairs that may still be taken. Ends early with budget < 0 when there are too many.
double by_area(const Triangle& a, const Triangle& b, int& budget) {
  if (--budget < 0) return 0;
  const BoundingSphere sphere_a = bounding_sphere(a), sphere_b = bounding_sphere(b);
  if (sphere_a.radius + sphere_b.radius <= kFarRatio * length(sphere_b.centre - sphere_a.centre)) {
    const Vec3 area_a = vector_area(a), area_b = vector_area(b);
    const Vec3 normal_a = normalized(area_a), normal_b = normalized(area_b);
    const auto& rule = triangle_rule_36();
    return length(area_a) * length(area_b) *
           mean_kernel(rule, rule.on(a), normal_a, dot(normal_a, a[0]), rule.on(b), normal_b, dot(normal_b, b[0]));
  }
  const bool split_a = sphere_a.radius >= sphere_b.radius;
  const Triangle& larger = split_a ? a : b;
  // Halving the longest edge keeps the pieces from becoming slivers.
  std::size_t k = 0;
  const auto edge = [&](std::size_t i) { return length(larger[(i + 1) % 3] - larger[i]); };
  for (std::size_t i = 1; i < 3; ++i)
    if (edge(i) > edge(k)) k = i;
  const Vec3 p = larger[k], q = larger[(k + 1) % 3], r = larger[(k + 2) % 3], middle = (p + q) * 0.5;
  const Triangle one{p, middle, r}, other{middle, q, r};
  return split_a ? by_area(one, b, budget) + by_area(other, b, budget)
                 : by_area(a, one, budget) + by_area(a, other, budget);
}

/// The triangles of a polygon, each clipped by the plane and cut into triangles again.
std::vector<Triangle> clipped_triangles(std::span<const Vec3> polygon, const Plane& plane, double on_plane) {
  std::vector<Triangle> pieces;
  for (const Triangle& triangle : triangulate(polygon)) {
    const ClippedTriangle clipped = clip_to_front(triangle, plane, on_plane);
    for (std::size_t k = 2; k < clipped.size; ++k)
      pieces.push_back({clipped.corner[0], clipped.corner[k - 1], clipped.corner[k]});
  }
  return pieces;
}

}  // namespace

double exchange_area(std::span<const Vec3> polygon1, std::span<const Vec3> polygon2) {
  if (polygon1.size() < 3 || polygon2.size() < 3) return 0;
  // Relative to a corner, so that pairs far from the origin keep their digits.
  const auto moved = [origin = polygon1[0]](std::span<const Vec3> polygon) {
    std::vector<Vec3> corners(polygon.begin(), polygon.end());
    for (Vec3& x : corners) x -= origin;
    return corners;
  };
  const std::vector<Vec3> p1 = moved(polygon1), p2 = moved(polygon2);
  const Vec3 area1 = vector_area(p1), area2 = vector_area(p2);
  if (!(dot(area1, area1) > 0) || !(dot(area2, area2) > 0)) return 0;
  const Plane plane1 = Plane::through(p1[0], normalized(area1)), plane2 = Plane::through(p2[0], normalized(area2));
  double span = 0;
  for (const Vec3& x : p1) span = std::max(span, length(x));
  for (const Vec3& x : p2) span = std::max(span, length(x));
  const double on_plane = 1e-14 * span;  // a shared corner lies on the other's plane but for rounding

  const std::vector<Vec3> front1 = clip_to_front(p1, plane2, on_plane), front2 = clip_to_front(p2, plane1, on_plane);
  if (front1.empty() || front2.empty()) return 0;

  const auto by_areas = [&](int budget) -> std::optional<double> {
    double sum = 0;
    const auto pieces2 = clipped_triangles(p2, plane1, on_plane);
    for (const Triangle& a : clipped_triangles(p1, plane2, on_plane))
      for (const Triangle& b : pieces2) sum += by_area(a, b, budget);
    return budget < 0 ? std::nullopt : std::optional(sum);
  };
  const BoundingSphere sphere1 = bounding_sphere(front1), sphere2 = bounding_sphere(front2);
  if (sphere1.radius + sphere2.radius <= kFarRatio * length(sphere2.centre - sphere1.centre))
    if (const auto sum = by_areas(1'000)) return std::max(*sum, 0.0);
  const ContourSum contour = contour_exchange(front1, front2);
  if (contour.rounding > kWorstRounding * contour.value)
    if (const auto sum = by_areas(20'000)) return std::max(*sum, 0.0);
  return std::max(contour.value, 0.0);
}

double polygon_to_polygon(std::span<const Vec3> polygon1, std::span<const Vec3> polygon2) {
  const double area = length(vector_area(polygon1));
  return area > 0 ? std::min(exchange_area(polygon1, polygon2) / area, 1.0) : 0;
}

}  // namespace clerestory
