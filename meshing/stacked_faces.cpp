#include "meshing/stacked_faces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "solver/model/box_tree.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

using Triangle2 = std::array<Point2, 3>;

/// Whether two triangles of one plane share more than a strip as wide as `margin`.
bool cover_each_other(const Triangle2& a, const Triangle2& b, double margin) {
  const auto parted_by_edge_of = [&](const Triangle2& s, const Triangle2& t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Point2 &p = s[k], &q = s[(k + 1) % 3], &apex = s[(k + 2) % 3];
      const double dx = q.x - p.x, dy = q.y - p.y, edge = std::hypot(dx, dy);
      const auto depth = [&](const Point2& x) { return (dx * (x.y - p.y) - dy * (x.x - p.x)) / edge; };
      const double side = depth(apex) > 0 ? 1 : -1;
      if (std::ranges::all_of(t, [&](const Point2& x) { return side * depth(x) <= margin; })) return true;
    }
    return false;
  };
  return !parted_by_edge_of(a, b) && !parted_by_edge_of(b, a);
}

double least_gap_in(const FaceComplex& complex, const PlaneGroup& group) {
  std::vector<HeightAsRead> heights;
  double low = Box::kHuge, high = -Box::kHuge;
  for (const std::uint32_t f : group.faces) {
    heights.push_back(height_as_read(complex, group.plane, complex.faces[f]));
    low = std::min(low, heights.back().low), high = std::max(high, heights.back().high);
  }
  if (!(high - low > complex.rounding)) return Box::kHuge;
  std::vector<Triangle2> flat;
  std::vector<Box> boxes;
  for (const std::uint32_t f : group.faces) {
    Triangle2 t;
    Box box;
    for (std::size_t k = 0; k < 3; ++k) {
      t[k] = group.plane.flatten(complex.vertices[complex.faces[f].corner[k]]);
      box.add(Vec3{t[k].x, t[k].y, 0});
    }
    flat.push_back(t);
    boxes.push_back(box);
  }
  const BoxTree tree(flat.size(), [&](std::uint32_t i) -> const Box& { return boxes[i]; });
  double least = Box::kHuge;
  for (std::uint32_t i = 0; i < flat.size(); ++i)
    tree.visit(boxes[i], [&](std::uint32_t j) {
      if (j <= i) return;
      const double gap = std::abs(gap_between(complex, heights[i], heights[j]));
      if (gap > 0 && gap < least && cover_each_other(flat[i], flat[j], complex.allowed.contact)) least = gap;
    });
  return least;
}

}  // namespace

HeightAsRead height_as_read(const FaceComplex& complex, const Plane& plane, const Face& face) {
  HeightAsRead height{Box::kHuge, -Box::kHuge};
  for (std::size_t k = 0; k < 3; ++k) {
    const double d = plane.distance(complex.as_read(face, k));
    height.low = std::min(height.low, d), height.high = std::max(height.high, d);
  }
  return height;
}

double gap_between(const FaceComplex& complex, const HeightAsRead& a, const HeightAsRead& b) {
  const double least = std::max(complex.rounding, (a.high - a.low) + (b.high - b.low));
  if (b.low - a.high > least) return b.low - a.high;
  if (a.low - b.high > least) return b.high - a.low;
  return 0;
}

double least_gap(const FaceComplex& complex, const std::vector<PlaneGroup>& groups) {
  std::vector<double> gap(groups.size(), Box::kHuge);
  parallel_for(groups.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g)
      if (groups[g].faces.size() > 1) gap[g] = least_gap_in(complex, groups[g]);
  });
  return gap.empty() ? Box::kHuge : *std::ranges::min_element(gap);
}

}  // namespace clerestory
