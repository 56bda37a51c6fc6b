#include "solver/visibility/tight_places.h"

#include <algorithm>
#include <cmath>

#include "solver/geometry/triangle.h"
#include "solver/model/parallel.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {
namespace {

constexpr double kReach = 2;         // lifts: what is further apart than that a lifted end cannot pass
constexpr double kBesideEdge = 10;   // reaches: from there on surfaces that meet at atan(1 / 10) are far enough apart
constexpr double kKeptOff = 0.2;     // reaches: VertexLightmap::kOffEdges, as a lift is 5e-7 of the diagonal
constexpr double kRounding = 0.05;   // reaches: what float moves a point sideways
constexpr double kSamePlane = 1e-3;  // reaches: two coordinates on the grid of meshing, and what a sliver leans

double distance(const Vec3& p, const std::array<Vec3, 3>& triangle) { return length(p - nearest_point(triangle, p)); }

/// The space over and under a triangle, up to `reach` from it, short of its edges by its insets.
class Prism {
 public:
  Prism(const std::array<Vec3, 3>& corner, double reach) : corner_(corner), reach_(reach) {
    const Vec3 n = cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double twice_area = length(n);
    normal_ = normalized(n);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 edge = corner[(k + 1) % 3] - corner[k];
      inward_[k] = normalized(cross(normal_, edge));
      const double height = twice_area / length(edge);
      // Vertices are evaluated so near to an edge: a third of their way to the centroid, less a tenth for bent facets.
      const double kept = 0.9 * VertexLightmap::way_inside(height, kKeptOff * reach) * height / 3;
      inset_[k] = std::min(kBesideEdge * reach, kept) - kRounding * reach;
    }
  }
  bool has_area() const { return length(normal_) > 0.5; }

  /// Whether the triangle comes into it, in another plane or upside down.
  bool meets(const std::array<Vec3, 3>& other) const {
    double low = Box::kHuge, high = -Box::kHuge;
    for (const Vec3& p : other) {
      const double h = dot(normal_, p - corner_[0]);
      low = std::min(low, h), high = std::max(high, h);
    }
    if (low > reach_ || high < -reach_) return false;
    for (std::size_t k = 0; k < 3; ++k)
      if (depth(k, other[0]) < inset_[k] && depth(k, other[1]) < inset_[k] && depth(k, other[2]) < inset_[k])
        return false;
    const std::vector<Vec3> inside = clip(other);
    if (inside.empty()) return false;
    const bool faces_alike = dot(normal_, cross(other[1] - other[0], other[2] - other[0])) > 0;
    return !faces_alike || std::ranges::any_of(inside, [&](const Vec3& p) {
      return std::abs(dot(normal_, p - corner_[0])) > kSamePlane * reach_;
    });
  }

 private:
  double depth(std::size_t edge, const Vec3& p) const { return dot(inward_[edge], p - corner_[edge]); }

  std::vector<Vec3> clip(const std::array<Vec3, 3>& other) const {
    std::vector<Vec3> polygon(other.begin(), other.end()), rest;
    const auto keep = [&](const auto& inside) {
      rest.clear();
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
        const double a = inside(p), b = inside(q);
        if (a >= 0) rest.push_back(p);
        if ((a < 0) != (b < 0)) rest.push_back(p + (q - p) * (a / (a - b)));
      }
      polygon.swap(rest);
    };
    keep([&](const Vec3& p) { return reach_ - dot(normal_, p - corner_[0]); });
    keep([&](const Vec3& p) { return reach_ + dot(normal_, p - corner_[0]); });
    for (std::size_t k = 0; k < 3; ++k) keep([&](const Vec3& p) { return depth(k, p) - inset_[k]; });
    return polygon;
  }

  std::array<Vec3, 3> corner_;
  double reach_;
  Vec3 normal_;
  std::array<Vec3, 3> inward_;  ///< unit normals of the edges within the plane
  std::array<double, 3> inset_;
};

}  // namespace

TightPlaces::TightPlaces(const PatchSet& patches, double lift) : reach_(kReach * lift) {
  const std::size_t count = patches.triangle_count();
  const auto corners_of = [&](std::size_t t) {
    const auto& c = patches.corners[t];
    return std::array{patches.vertices[c[0]], patches.vertices[c[1]], patches.vertices[c[2]]};
  };
  const auto box_of = [&](std::size_t t) { return Box::around(corners_of(t)).grown(reach_); };
  const BoxTree tree(count, box_of);
  std::vector<Kind> tight(count, Kind::clear);
  parallel_for(count, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t t = tree.order()[k];
      const Prism prism(corners_of(t), reach_);
      if (!prism.has_area()) continue;
      tree.visit(box_of(t), [&](std::uint32_t other) {
        if (other != t && tight[t] == Kind::clear && prism.meets(corners_of(other))) tight[t] = Kind::tight;
      });
    }
  });
  std::vector<Box> boxes;
  for (std::size_t t = 0; t < count; ++t)
    if (tight[t] == Kind::tight) {
      triangles_.push_back(corners_of(t));
      boxes.push_back(box_of(t));
    }
  if (triangles_.empty()) return;
  cells_.lay(triangles_, reach_);
  tree_.emplace(triangles_.size(), StoredBoxes{std::move(boxes)});
  parallel_for(count, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      if (tight[t] == Kind::clear) tree_->visit(box_of(t), [&](std::uint32_t) { tight[t] = Kind::beside; });
  });
  tight_ = std::move(tight);
}

void TightPlaces::Cells::lay(const std::vector<std::array<Vec3, 3>>& triangles, double reach) {
  constexpr double kMostCells = 1 << 24;   // bits: 2 MB, which stay near the processor
  constexpr double kMostInARow = 1 << 10;  // where all lie in a plane: there are as many by as many
  constexpr double kMostInReach = 4;  // smaller ones tell no more: something far away may make the reach a room's size
  Box all;
  for (const auto& triangle : triangles)
    for (const Vec3& corner : triangle) all.add(corner);
  all = all.grown(reach);
  lower_ = all.lower;
  const Vec3 size = all.upper - all.lower;
  per_metre_ = std::min({std::cbrt(kMostCells / (size.x * size.y * size.z)),
                         kMostInARow / std::max({size.x, size.y, size.z}), kMostInReach / reach});
  for (std::size_t k = 0; k < 3; ++k) count_[k] = static_cast<std::size_t>(size[static_cast<int>(k)] * per_metre_) + 1;
  is_near_.assign(count_[0] * count_[1] * count_[2], false);
  for (const auto& triangle : triangles) {
    const Box box = Box::around(triangle).grown(reach);
    Range range;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto cell = [&](const Vec3& p) {
        return static_cast<std::size_t>((p - lower_)[static_cast<int>(k)] * per_metre_);
      };
      range[k] = {cell(box.lower), std::min(cell(box.upper), count_[k] - 1) + 1};
    }
    mark(triangle, reach, range);
  }
}

void TightPlaces::Cells::mark(const std::array<Vec3, 3>& triangle, double reach, const Range& range) {
  std::array<double, 3> middle, half;
  std::size_t longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [begin, end] = range[k];
    middle[k] = static_cast<double>(begin + end) / 2 / per_metre_,
    half[k] = static_cast<double>(end - begin) / 2 / per_metre_;
    if (half[k] > half[longest]) longest = k;
  }
  const double far = std::hypot(half[0], half[1], half[2]) + reach;
  if (distance(lower_ + Vec3{middle[0], middle[1], middle[2]}, triangle) > far) return;
  const auto [begin, end] = range[longest];
  if (end - begin == 1) {
    is_near_[(range[2][0] * count_[1] + range[1][0]) * count_[0] + range[0][0]] = true;
    return;
  }
  Range part = range;
  part[longest] = {begin, (begin + end) / 2};
  mark(triangle, reach, part);
  part[longest] = {(begin + end) / 2, end};
  mark(triangle, reach, part);
}

bool TightPlaces::Cells::may_hold(const Vec3& p) const {
  const Vec3 at = (p - lower_) * per_metre_;
  if (!(at.x >= 0 && at.y >= 0 && at.z >= 0)) return false;
  const auto x = static_cast<std::size_t>(at.x), y = static_cast<std::size_t>(at.y), z = static_cast<std::size_t>(at.z);
  return x < count_[0] && y < count_[1] && z < count_[2] && is_near_[(z * count_[1] + y) * count_[0] + x];
}

bool TightPlaces::contains(const Vec3& p) const {
  if (!tree_ || !cells_.may_hold(p)) return false;
  bool found = false;
  tree_->visit_if(
      [&](const Box& box) {
        return !found && p.x >= box.lower.x && p.x <= box.upper.x && p.y >= box.lower.y && p.y <= box.upper.y &&
               p.z >= box.lower.z && p.z <= box.upper.z;
      },
      [&](std::uint32_t k) { found = found || distance(p, triangles_[k]) <= reach_; });
  return found;
}

}  // namespace clerestory
