#include "solver/form_factors/triangle_to_triangle.h"

#include <algorithm>
#include <span>

#include "solver/form_factors/contour_exchange.h"
#include "solver/form_factors/polygon_to_polygon.h"
#include "solver/geometry/polygon.h"

namespace clerestory {
namespace {

// ((r_a + r_b) / distance)^2 up to which each rule keeps the relative error below about 1e-4; measured over random
// pairs of all orientations, the worst of 1e5 (TriangleToTriangle.StaysWithinItsErrorForRandomPairs).
constexpr double kRatio2Of3Points = 0.06 * 0.06;
constexpr double kRatio2Of6Points = 0.27 * 0.27;
constexpr double kRatio2Of12Points = 0.50 * 0.50;

template <std::size_t Points>
double product(const TriangleRule<Points>& rule, const QuadratureTriangle& a, const TrianglePoints<Points>& points_a,
               const QuadratureTriangle& b, const TrianglePoints<Points>& points_b) {
  return a.area * b.area * mean_kernel(rule, points_a, a.normal, a.offset, points_b, b.normal, b.offset);
}

double by_contour(std::span<const Vec3> a, std::span<const Vec3> b) {
  const ContourSum sum = contour_exchange(a, b);
  // Rounding spoils pairs that are both thin and far apart; they are rare enough for the slow way.
  return sum.rounding < 1e-6 * sum.value ? sum.value : exchange_area(a, b);
}

struct Heights {
  double lowest, highest;
};
Heights heights_over(const QuadratureTriangle& plane, const QuadratureTriangle& triangle) {
  const double h0 = dot(plane.normal, triangle.corner[0]) - plane.offset;
  const double h1 = dot(plane.normal, triangle.corner[1]) - plane.offset;
  const double h2 = dot(plane.normal, triangle.corner[2]) - plane.offset;
  return {std::min({h0, h1, h2}), std::max({h0, h1, h2})};
}

/// A pair that the horizon of one or both cuts. The parts that are left are no smoother to integrate by a rule than the
/// whole, but are where the integrand does not vanish.
double clipped_exchange(const QuadratureTriangle& a, const QuadratureTriangle& b, double on_plane) {
  const ClippedTriangle front_a = clip_to_front(a.corner, {b.normal, b.offset}, on_plane);
  const ClippedTriangle front_b = clip_to_front(b.corner, {a.normal, a.offset}, on_plane);
  if (front_a.size == 0 || front_b.size == 0) return 0;
  const Vec3 apart = b.centre - a.centre;
  const double reach = a.radius + b.radius;
  if (reach * reach > kRatio2Of6Points * dot(apart, apart)) return by_contour(front_a.corners(), front_b.corners());
  const auto& rule = triangle_rule_6();
  double sum = 0;
  for (std::size_t i = 2; i < front_a.size; ++i) {
    const std::array<Vec3, 3> piece_a{front_a.corner[0], front_a.corner[i - 1], front_a.corner[i]};
    const double area_a = length(vector_area(piece_a));
    const auto points_a = rule.on(piece_a);
    for (std::size_t j = 2; j < front_b.size; ++j) {
      const std::array<Vec3, 3> piece_b{front_b.corner[0], front_b.corner[j - 1], front_b.corner[j]};
      sum += area_a * length(vector_area(piece_b)) *
             mean_kernel(rule, points_a, a.normal, a.offset, rule.on(piece_b), b.normal, b.offset);
    }
  }
  return std::max(sum, 0.0);
}

}  // namespace

QuadratureTriangle::QuadratureTriangle(const std::array<Vec3, 3>& corners) : corner(corners) {
  const Vec3 scaled = vector_area(corners);
  area = length(scaled);
  normal = normalized(scaled);
  offset = dot(normal, corners[0]);
  const BoundingSphere sphere = bounding_sphere(corners);
  centre = sphere.centre;
  radius = sphere.radius;
  points3 = triangle_rule_3().on(corners);
  points6 = triangle_rule_6().on(corners);
  points12 = triangle_rule_12().on(corners);
}

double triangle_exchange(const QuadratureTriangle& a, const QuadratureTriangle& b) {
  const Heights of_a = heights_over(b, a), of_b = heights_over(a, b);
  const Vec3 apart = b.centre - a.centre;
  const double distance2 = dot(apart, apart), reach = a.radius + b.radius;
  // Rounding of plane offsets far from the origin, against which a shared corner counts as on the plane.
  const double on_plane = 1e-13 * (std::abs(a.offset) + std::abs(b.offset) + reach + std::sqrt(distance2));
  if (of_a.highest <= on_plane || of_b.highest <= on_plane) return 0;
  if (of_a.lowest < -on_plane || of_b.lowest < -on_plane) return clipped_exchange(a, b, on_plane);

  if (reach * reach <= kRatio2Of3Points * distance2) return product(triangle_rule_3(), a, a.points3, b, b.points3);
  if (reach * reach <= kRatio2Of6Points * distance2) return product(triangle_rule_6(), a, a.points6, b, b.points6);
  if (reach * reach <= kRatio2Of12Points * distance2) return product(triangle_rule_12(), a, a.points12, b, b.points12);
  return by_contour(a.corner, b.corner);
}

}  // namespace clerestory
