#include "solver/geometry/polygon.h"

#include <algorithm>

namespace clerestory {
namespace {

/// Sutherland and Hodgman against one plane; calls emit(corner) for each corner of the result. True when any corner
/// rises above the plane.
template <class Emit>
bool clip(std::span<const Vec3> polygon, const HalfSpace& plane, double on_plane, Emit emit) {
  const auto height_of = [&](const Vec3& x) {
    const double h = plane.height(x);
    return std::abs(h) <= on_plane ? 0.0 : h;
  };
  bool rises = false;
  Vec3 a = polygon.back();
  double height_a = height_of(a);
  for (const Vec3& b : polygon) {
    const double height_b = height_of(b);
    rises |= height_b > 0;
    if (height_a * height_b < 0) emit(a + (b - a) * (height_a / (height_a - height_b)));
    if (height_b >= 0) emit(b);
    a = b;
    height_a = height_b;
  }
  return rises;
}

}  // namespace

Vec3 vector_area(std::span<const Vec3> polygon) {
  Vec3 sum;
  // Relative to the first corner, so that polygons far from the origin lose no digits.
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
    sum += cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
  return sum * 0.5;
}

BoundingSphere bounding_sphere(std::span<const Vec3> polygon) {
  BoundingSphere sphere;
  for (const Vec3& corner : polygon) sphere.centre += corner / static_cast<double>(polygon.size());
  double radius2 = 0;
  for (const Vec3& corner : polygon) radius2 = std::max(radius2, dot(corner - sphere.centre, corner - sphere.centre));
  sphere.radius = std::sqrt(radius2);
  return sphere;
}

std::vector<Vec3> clip_to_front(std::span<const Vec3> polygon, const HalfSpace& plane, double on_plane) {
  std::vector<Vec3> front;
  if (polygon.size() < 3) return front;
  front.reserve(polygon.size() + 2);
  if (!clip(polygon, plane, on_plane, [&](const Vec3& x) { front.push_back(x); }) || front.size() < 3) front.clear();
  return front;
}

ClippedTriangle clip_to_front(const std::array<Vec3, 3>& triangle, const HalfSpace& plane, double on_plane) {
  ClippedTriangle front;
  if (!clip(triangle, plane, on_plane, [&](const Vec3& x) { front.corner[front.size++] = x; }) || front.size < 3)
    front.size = 0;
  return front;
}

std::vector<std::array<Vec3, 3>> triangulate(std::span<const Vec3> polygon) {
  std::vector<std::array<Vec3, 3>> triangles;
  const Vec3 normal = normalized(vector_area(polygon));
  std::vector<Vec3> rest(polygon.begin(), polygon.end());
  const auto twice_area = [&](const Vec3& a, const Vec3& b, const Vec3& c) { return dot(normal, cross(b - a, c - a)); };
  while (rest.size() >= 3) {
    const std::size_t n = rest.size();
    std::size_t best = n;
    double best_area = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3 &a = rest[(k + n - 1) % n], &b = rest[k], &c = rest[(k + 1) % n];
      const double area = twice_area(a, b, c);
      if (area <= best_area) continue;  // the largest ear first keeps slivers to the last
      const bool holds_a_corner = std::ranges::any_of(rest, [&](const Vec3& x) {
        return x != a && x != b && x != c && twice_area(a, b, x) >= 0 && twice_area(b, c, x) >= 0 &&
               twice_area(c, a, x) >= 0;
      });
      if (!holds_a_corner) best = k, best_area = area;
    }
    if (best == n) break;  // what is left has no area
    triangles.push_back({rest[(best + n - 1) % n], rest[best], rest[(best + 1) % n]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return triangles;
}

}  // namespace clerestory
