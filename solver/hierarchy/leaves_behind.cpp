#include "solver/hierarchy/leaves_behind.h"

#include <algorithm>
#include <array>
#include <vector>

namespace clerestory {
namespace {

struct Point {
  double x, y;
};
using Corners = std::array<Point, 3>;

double twice_area(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Area that two triangles, both counter-clockwise, have in common: one clipped by the edges of the other.
double overlap(const Corners& a, const Corners& b) {
  std::vector<Point> polygon(a.begin(), a.end()), clipped;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point &from = b[k], &to = b[(k + 1) % 3];
    clipped.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const double p_inside = twice_area(from, to, p), q_inside = twice_area(from, to, q);
      if (p_inside >= 0) clipped.push_back(p);
      if ((p_inside > 0 && q_inside < 0) || (p_inside < 0 && q_inside > 0)) {
        const double t = p_inside / (p_inside - q_inside);
        clipped.push_back({p.x + (q.x - p.x) * t, p.y + (q.y - p.y) * t});
      }
    }
    polygon.swap(clipped);
  }
  double sum = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) sum += twice_area(polygon[0], polygon[i - 1], polygon[i]);
  return sum / 2;
}

/// In the plane of the frame, counter-clockwise as seen along its normal, whichever side they are of.
Corners in_plane(const std::array<Vec3, 3>& corner, const Frame& frame) {
  Corners out;
  for (std::size_t k = 0; k < 3; ++k) out[k] = {dot(corner[k], frame.t), dot(corner[k], frame.b)};
  if (twice_area(out[0], out[1], out[2]) < 0) std::swap(out[1], out[2]);
  return out;
}

}  // namespace

void find_leaves_behind(const PatchSet& patches, std::span<const std::uint32_t> patch_of_leaf, PatchSet& leaves) {
  if (patches.tau.value.empty()) return;
  const std::size_t n = patch_of_leaf.size();
  std::vector<std::uint32_t> first_leaf(patches.patch_count() + 1, 0);
  for (const std::uint32_t p : patch_of_leaf) ++first_leaf[p + 1];
  for (std::size_t p = 0; p < patches.patch_count(); ++p) first_leaf[p + 1] += first_leaf[p];

  constexpr double kTouching = 1e-9;  // of the leaf's area: rounding, no overlap
  leaves.tau = Field(n, patches.channels);
  leaves.behind_begin.assign(1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t p = patch_of_leaf[i];
    leaves.tau.set(i, patches.tau[p]);
    for (const PatchSet::Behind& other : patches.patches_behind(p)) {
      const Frame frame(patches.normal[p]);
      const Corners here = in_plane(leaves.corner_positions(PatchId{i}), frame);
      const std::size_t begin = leaves.behind.size();
      double sum = 0;
      for (std::size_t j = first_leaf[other.patch]; j < first_leaf[other.patch.value + 1]; ++j) {
        const double area = overlap(here, in_plane(leaves.corner_positions(PatchId{j}), frame));
        if (!(area > kTouching * leaves.area[i])) continue;
        leaves.behind.push_back({PatchId{j}, area});
        sum += area;
      }
      for (std::size_t k = begin; k < leaves.behind.size(); ++k) leaves.behind[k].share /= sum;
    }
    leaves.behind_begin.push_back(static_cast<std::uint32_t>(leaves.behind.size()));
  }
}

}  // namespace clerestory
