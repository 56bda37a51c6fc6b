#include "solver/form_factors/polygon_to_polygon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "solver/form_factors/contour_exchange.h"
#include "solver/form_factors/triangle_quadrature.h"
#include "solver/geometry/polygon.h"

namespace clerestory {
namespace {

/// (r1 + r2) / distance up to which 36 x 36 Gauss points leave less than 1e-9.
constexpr double kFarRatio = 0.25;
/// The rule's error grows about like the ratio to this power, as a rule exact for degree 10 should.
constexpr double kRatioPower = 11;
/// Beyond this ratio that is no longer so.
constexpr double kLargestRatio = 0.8;
/// Pieces this small against the pair add less than the square of it where the triangles touch in a point.
constexpr double kSmallestPiece = 1e-5;
/// Share of the contour sum that rounding may spoil before areas are integrated instead.
constexpr double kWorstRounding = 1e-9;

using Triangle = std::array<Vec3, 3>;

struct Piece {
  Triangle corner;
  double area;
};
struct PiecePair {
  Piece a, b;
};

/// Smallest height of a triangle over one of its edges.
double smallest_height(const Triangle& t) {
  const double longest = std::max({length(t[1] - t[0]), length(t[2] - t[1]), length(t[0] - t[2])});
  return longest > 0 ? 2 * length(vector_area(t)) / longest : 0;
}

std::array<Piece, 2> halves(const Piece& piece) {
  // Halving the longest edge keeps the pieces from becoming slivers.
  const Triangle& c = piece.corner;
  std::size_t k = 0;
  const auto edge = [&](std::size_t i) { return length(c[(i + 1) % 3] - c[i]); };
  for (std::size_t i = 1; i < 3; ++i)
    if (edge(i) > edge(k)) k = i;
  const Vec3 p = c[k], q = c[(k + 1) % 3], r = c[(k + 2) % 3], middle = (p + q) * 0.5;
  return {Piece{{p, middle, r}, 0.5 * piece.area}, Piece{{middle, q, r}, 0.5 * piece.area}};
}

/// Calls take(a, b) for pairs of pieces that cover two triangles and are far enough apart for the rule, halving what is
/// near; `budget` counts the pairs looked at. False, and stopped early, when there are too many.
///
/// Where triangles touch in a point, halving would go on for ever. There the exchange of what lies within s times the
/// size of the pair is s^2 of the whole, because the kernel times both areas scales like that. So pieces may be nearer
/// the smaller they are, for the same error of the whole, and the last ones are left out. Without the first, a corner
/// takes ten times as many pairs. Along a shared edge the pairs multiply at each scale: the budget ends that.
template <class Take>
bool far_pieces(const Triangle& a, const Triangle& b, int& budget, Take take) {
  const double size = std::min(smallest_height(a), smallest_height(b));
  if (!(size > 0)) return true;
  // A list and no recursion: its length is bounded by the budget, and threads have small stacks.
  std::vector<PiecePair> open{{{a, length(vector_area(a))}, {b, length(vector_area(b))}}};
  while (!open.empty()) {
    if (--budget < 0) return false;
    const PiecePair pair = open.back();
    open.pop_back();
    const BoundingSphere sphere_a = bounding_sphere(pair.a.corner), sphere_b = bounding_sphere(pair.b.corner);
    const double reach = sphere_a.radius + sphere_b.radius, distance = length(sphere_b.centre - sphere_a.centre);
    const double s = reach / size;
    const bool may_be_far = reach <= kLargestRatio * distance;
    if (may_be_far &&
        reach <= distance * std::min(kLargestRatio, kFarRatio * std::pow(std::min(s, 1.0), -2 / kRatioPower))) {
      take(pair.a, pair.b);
    } else if (s > kSmallestPiece) {
      if (sphere_a.radius >= sphere_b.radius)
        for (const Piece& half : halves(pair.a)) open.push_back({half, pair.b});
      else
        for (const Piece& half : halves(pair.b)) open.push_back({pair.a, half});
    }
  }
  return true;
}

/// The triangles of a polygon, each clipped by the plane and cut into triangles again.
std::vector<Triangle> clipped_triangles(std::span<const Vec3> polygon, const HalfSpace& plane, double on_plane) {
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
  // Relative to a corner, so that pairs far from the origin keep their digits; the same one when the polygons are
  // swapped, for grazing pairs feel the rounding of this.
  const auto before = [](const Vec3& a, const Vec3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  };
  const Vec3 first1 = *std::ranges::min_element(polygon1, before), first2 = *std::ranges::min_element(polygon2, before);
  const auto moved = [origin = before(first2, first1) ? first2 : first1](std::span<const Vec3> polygon) {
    std::vector<Vec3> corners(polygon.begin(), polygon.end());
    for (Vec3& x : corners) x -= origin;
    return corners;
  };
  const std::vector<Vec3> p1 = moved(polygon1), p2 = moved(polygon2);
  const Vec3 area1 = vector_area(p1), area2 = vector_area(p2);
  if (!(dot(area1, area1) > 0) || !(dot(area2, area2) > 0)) return 0;
  const HalfSpace plane1 = HalfSpace::through(p1[0], normalized(area1)),
                  plane2 = HalfSpace::through(p2[0], normalized(area2));
  double span = 0;
  for (const Vec3& x : p1) span = std::max(span, length(x));
  for (const Vec3& x : p2) span = std::max(span, length(x));
  const double on_plane = 1e-14 * span;  // a shared corner lies on the other's plane but for rounding

  const std::vector<Vec3> front1 = clip_to_front(p1, plane2, on_plane), front2 = clip_to_front(p2, plane1, on_plane);
  if (front1.empty() || front2.empty()) return 0;

  const auto by_areas = [&](int budget) -> std::optional<double> {
    const auto pieces1 = clipped_triangles(p1, plane2, on_plane), pieces2 = clipped_triangles(p2, plane1, on_plane);
    const auto all_far_pieces = [&](int left, auto take) {
      for (const Triangle& a : pieces1)
        for (const Triangle& b : pieces2)
          if (!far_pieces(a, b, left, take)) return false;
      return true;
    };
    // Counting costs a tenth of integrating.
    if (!all_far_pieces(budget, [](const Piece&, const Piece&) {})) return std::nullopt;
    double sum = 0;
    const auto& rule = triangle_rule_36();
    all_far_pieces(budget, [&](const Piece& a, const Piece& b) {
      sum += a.area * b.area *
             mean_kernel(rule, rule.on(a.corner), plane1.normal, dot(plane1.normal, a.corner[0]), rule.on(b.corner),
                         plane2.normal, dot(plane2.normal, b.corner[0]));
    });
    return sum;
  };
  const BoundingSphere sphere1 = bounding_sphere(front1), sphere2 = bounding_sphere(front2);
  if (sphere1.radius + sphere2.radius <= kFarRatio * length(sphere2.centre - sphere1.centre))
    if (const auto sum = by_areas(1'000)) return std::max(*sum, 0.0);
  const ContourSum contour = contour_exchange(front1, front2);
  if (contour.rounding > kWorstRounding * contour.value)
    if (const auto sum = by_areas(40'000)) return std::max(*sum, 0.0);
  // Rounding of slivers' contours may exceed their areas.
  return std::clamp(contour.value, 0.0, std::min(length(area1), length(area2)));
}

double polygon_to_polygon(std::span<const Vec3> polygon1, std::span<const Vec3> polygon2) {
  const double area = length(vector_area(polygon1));
  return area > 0 ? std::min(exchange_area(polygon1, polygon2) / area, 1.0) : 0;
}

}  // namespace clerestory
