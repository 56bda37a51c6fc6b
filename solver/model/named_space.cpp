#include "solver/model/named_space.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace clerestory {
namespace {

constexpr std::size_t kMostToCount = 3000;

template <class Visit>
void each_triangle(const NamedSpace& space, const Visit& visit) {
  for (std::size_t c = 0; c + 2 < space.corner.size(); c += 3)
    visit(space.vertices[space.corner[c]], space.vertices[space.corner[c + 1]], space.vertices[space.corner[c + 2]]);
}

/// Twice the signed area in plan of p, q and the point (x, y).
double side(const Vec3& p, const Vec3& q, double x, double y) {
  return (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
}

/// Where the vertical line through (x, y) meets a triangle; nothing when it passes by, or the triangle stands up.
std::optional<double> height_at(const Vec3& a, const Vec3& b, const Vec3& c, double x, double y) {
  const double area = cross(b - a, c - a).z;
  if (area == 0) return std::nullopt;
  // An edge counts to its left, taken upwards, so that the line meets one of two triangles at their common edge.
  const auto is_left = [&](const Vec3& p, const Vec3& q) {
    const bool down = p.y > q.y || (p.y == q.y && p.x > q.x);
    return down ? side(q, p, x, y) < 0 : side(p, q, x, y) >= 0;
  };
  const bool left = area > 0;
  if (is_left(a, b) != left || is_left(b, c) != left || is_left(c, a) != left) return std::nullopt;
  return (side(b, c, x, y) * a.z + side(c, a, x, y) * b.z + side(a, b, x, y) * c.z) / area;
}

}  // namespace

double floor_area(const NamedSpace& space) {
  double twice = 0;
  each_triangle(space, [&](const Vec3& a, const Vec3& b, const Vec3& c) { twice += std::abs(cross(b - a, c - a).z); });
  return twice / 4;
}

double volume(const NamedSpace& space) {
  if (!space.has_volume()) return 0;
  const Vec3 from = space.vertices[space.corner[0]];
  if (space.corner.size() > 3 * kMostToCount) {
    double six = 0;
    each_triangle(
        space, [&](const Vec3& a, const Vec3& b, const Vec3& c) { six += dot(a - from, cross(b - from, c - from)); });
    return std::abs(six) / 6;
  }
  const double low = from.z;  // near, so that a space far up keeps its digits
  double sum = 0;
  each_triangle(space, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 middle = (a + b + c) / 3;
    // A floor has an even number of faces below it, a ceiling an odd one; models wind their faces as they like.
    std::size_t below = 0;
    each_triangle(space, [&](const Vec3& p, const Vec3& q, const Vec3& r) {
      const auto z = height_at(p, q, r, middle.x, middle.y);
      below += z && *z < middle.z - 1e-9;
    });
    const double area = std::abs(cross(b - a, c - a).z) / 2;
    sum += (below % 2 == 1 ? area : -area) * (middle.z - low);
  });
  return std::abs(sum);
}

double height(const NamedSpace& space) {
  if (!space.has_volume()) return 0;
  const auto by_z = [&](std::uint32_t a, std::uint32_t b) { return space.vertices[a].z < space.vertices[b].z; };
  const auto [low, high] = std::minmax_element(space.corner.begin(), space.corner.end(), by_z);
  return space.vertices[*high].z - space.vertices[*low].z;
}

std::vector<SpaceSpan> spans_at(const NamedSpace& space, double x, double y) {
  std::vector<double> z;
  each_triangle(space, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    if (const auto at = height_at(a, b, c, x, y)) z.push_back(*at);
  });
  std::sort(z.begin(), z.end());
  std::vector<SpaceSpan> spans;
  for (std::size_t k = 0; k + 1 < z.size(); k += 2)
    if (z[k + 1] > z[k]) spans.push_back({z[k], z[k + 1]});
  return spans;
}

Vec3 wall_direction(const NamedSpace& space) {
  Vec3 longest{1, 0, 0};
  double length2 = 0;
  each_triangle(space, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    // Diagonals of a flat floor are edges of triangles, too, and no walls: only triangles that stand up are asked.
    const Vec3 normal = cross(b - a, c - a);
    if (std::hypot(normal.x, normal.y) <= std::abs(normal.z)) return;
    for (const Vec3& edge : {b - a, c - b, a - c}) {
      const double plan2 = edge.x * edge.x + edge.y * edge.y;
      if (std::abs(edge.z) > 1e-6 * std::sqrt(plan2) || plan2 <= length2 * (1 + 1e-9)) continue;
      length2 = plan2;
      longest = normalized(Vec3{edge.x, edge.y, 0});
    }
  });
  return longest;
}

}  // namespace clerestory
