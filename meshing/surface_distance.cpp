#include "meshing/surface_distance.h"

#include <algorithm>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

namespace clerestory {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>;

constexpr int kHalvings = 24;

double distance(const Point& p, const Kernel::Triangle_3& t) { return std::sqrt(CGAL::squared_distance(p, t)); }

/// A piece of a triangle, and the distance of each of its corners with the triangle that is nearest there.
struct Piece {
  std::array<Point, 3> corner;
  std::array<double, 3> off;
  std::array<Triangles::const_iterator, 3> nearest;
  int halvings = 0;
};

class Surface {
 public:
  explicit Surface(std::span<const TriangleCorners> triangles) {
    for (const auto& [a, b, c] : triangles) triangles_.emplace_back(point(a), point(b), point(c));
    tree_.insert(triangles_.cbegin(), triangles_.cend());
  }
  static Point point(const Vec3& v) { return {v.x, v.y, v.z}; }

  void look(Piece& piece, std::size_t k) const {
    piece.nearest[k] = tree_.closest_point_and_primitive(piece.corner[k]).second;
    piece.off[k] = distance(piece.corner[k], *piece.nearest[k]);
  }

  /// The distance from a triangle is convex: over a piece it is largest at a corner. So the nearest triangle of any of
  /// the corners bounds the distance of the whole piece.
  double bound(const Piece& piece) const {
    double least = 1e300;
    for (const auto& near : piece.nearest) {
      double most = 0;
      for (const Point& p : piece.corner) most = std::max(most, distance(p, *near));
      least = std::min(least, most);
    }
    return least;
  }

 private:
  Triangles triangles_;
  Tree tree_;
};

}  // namespace

std::optional<double> farthest_distance(std::span<const TriangleCorners> from, std::span<const TriangleCorners> to,
                                        double most) {
  const Surface surface(to);
  double farthest = 0;
  std::vector<Piece> left;
  for (const TriangleCorners& t : from) {
    Piece whole{{Surface::point(t[0]), Surface::point(t[1]), Surface::point(t[2])}, {}, {}, 0};
    for (std::size_t k = 0; k < 3; ++k) surface.look(whole, k);
    left.assign(1, whole);
    while (!left.empty()) {
      const Piece piece = left.back();
      left.pop_back();
      const double reached = std::ranges::max(piece.off), bound = surface.bound(piece);
      if (reached > most || (bound > most && piece.halvings == kHalvings)) return {};
      const bool is_close = bound <= std::max(farthest, std::min(most, reached + most / 4));
      if (is_close || piece.halvings == kHalvings) {
        farthest = std::max(farthest, bound);
        continue;
      }
      // Across the longest edge.
      std::size_t k = 0;
      double longest = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const double l = CGAL::squared_distance(piece.corner[i], piece.corner[(i + 1) % 3]);
        if (l > longest) longest = l, k = i;
      }
      Piece first = piece;
      ++first.halvings;
      first.corner[k] = CGAL::midpoint(piece.corner[k], piece.corner[(k + 1) % 3]);
      surface.look(first, k);
      Piece second = piece;
      ++second.halvings;
      second.corner[(k + 1) % 3] = first.corner[k];
      second.off[(k + 1) % 3] = first.off[k];
      second.nearest[(k + 1) % 3] = first.nearest[k];
      left.push_back(first);
      left.push_back(second);
    }
  }
  return farthest;
}

}  // namespace clerestory
