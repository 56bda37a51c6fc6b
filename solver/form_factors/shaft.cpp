#include "solver/form_factors/shaft.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/model/parallel.h"

namespace clerestory {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Box kEmptyBox{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

/// Least value of dot(normal, x) over the box.
double least_height(const Box& box, const Vec3& normal) {
  return normal.x * (normal.x > 0 ? box.lower.x : box.upper.x) + normal.y * (normal.y > 0 ? box.lower.y : box.upper.y) +
         normal.z * (normal.z > 0 ? box.lower.z : box.upper.z);
}

Vec3 centre(const Box& box) { return (box.lower + box.upper) * 0.5; }

double& coordinate(Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// The convex hull of two boxes as half-spaces dot(normal, x) <= offset.
struct BoxShaft {
  Box bounds;
  std::array<Vec3, 12> normal;
  std::array<double, 12> offset;
  std::size_t sides = 0;

  BoxShaft(const Box& a, const Box& b) : bounds(a) {
    bounds.grow(b);
    const Box* const boxes[2] = {&a, &b};
    // A slanted side runs parallel to one axis; across it, it joins the same corner of both boxes.
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int corner = 0; corner < 4; ++corner) {
        const auto at = [&](const Box& box, int which, int along) {
          return which ? box.upper[along] : box.lower[along];
        };
        const double au = at(a, corner & 1, u), av = at(a, corner >> 1, v);
        const double bu = at(b, corner & 1, u), bv = at(b, corner >> 1, v);
        const double across = std::hypot(bu - au, bv - av);
        if (across == 0) continue;
        Vec3 n;
        coordinate(n, u) = (bv - av) / across, coordinate(n, v) = -(bu - au) / across;
        double low = kInfinity, high = -kInfinity;
        for (const Box* box : boxes)
          low = std::min(low, least_height(*box, n)), high = std::max(high, -least_height(*box, -n));
        const double here = n[u] * au + n[v] * av, slack = 1e-12 * (std::abs(here) + across);
        if (high <= here + slack) hold(n, high);
        else if (low >= here - slack) hold(-n, -low);
      }
    }
  }
  void hold(const Vec3& n, double o) { normal[sides] = n, offset[sides++] = o; }

  bool reaches(const Box& box, double touching) const {
    if (box.lower.x >= bounds.upper.x - touching || box.upper.x <= bounds.lower.x + touching ||
        box.lower.y >= bounds.upper.y - touching || box.upper.y <= bounds.lower.y + touching ||
        box.lower.z >= bounds.upper.z - touching || box.upper.z <= bounds.lower.z + touching)
      // A flat shaft or a flat blocker has no inside along that axis; only true separation counts there.
      if (separated_or_flat(box, touching)) return false;
    for (std::size_t k = 0; k < sides; ++k)
      if (least_height(box, normal[k]) >= offset[k] - touching) return false;
    return true;
  }

 private:
  bool separated_or_flat(const Box& box, double touching) const {
    for (int axis = 0; axis < 3; ++axis) {
      const bool flat_shaft = bounds.upper[axis] - bounds.lower[axis] <= 2 * touching;
      const double margin = flat_shaft ? -touching : touching;
      if (box.lower[axis] >= bounds.upper[axis] - margin || box.upper[axis] <= bounds.lower[axis] + margin) return true;
    }
    return false;
  }
};

}  // namespace

Box Box::around(std::span<const Vec3> points) {
  Box box = kEmptyBox;
  for (const Vec3& x : points) box.grow({x, x});
  return box;
}

void Box::grow(const Box& other) {
  lower = {std::min(lower.x, other.lower.x), std::min(lower.y, other.lower.y), std::min(lower.z, other.lower.z)};
  upper = {std::max(upper.x, other.upper.x), std::max(upper.y, other.upper.y), std::max(upper.z, other.upper.z)};
}

Blockers::Blockers(const PatchSet& patches) {
  const Box scene = Box::around(patches.vertices);
  if (patches.triangle_count() == 0) return;
  touching_ = 1e-9 * length(scene.upper - scene.lower);

  std::vector<std::uint8_t> blocks(patches.triangle_count(), 0);
  parallel_for(patches.triangle_count(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto& c = patches.corners[t];
      const Vec3 a = patches.vertices[c[0]];
      const Vec3 normal = normalized(cross(patches.vertices[c[1]] - a, patches.vertices[c[2]] - a));
      const double offset = dot(normal, a);
      bool above = false, below = false;
      for (const Vec3& x : patches.vertices) {
        const double height = dot(normal, x) - offset;
        above |= height > touching_, below |= height < -touching_;
        if (above && below) break;
      }
      blocks[t] = above && below;
    }
  });
  std::vector<Box> boxes;
  for (std::size_t t = 0; t < patches.triangle_count(); ++t) {
    if (!blocks[t]) continue;
    const auto& c = patches.corners[t];
    const std::array<Vec3, 3> corner{patches.vertices[c[0]], patches.vertices[c[1]], patches.vertices[c[2]]};
    boxes.push_back(Box::around(corner));
  }
  triangles_ = boxes.size();
  nodes_.reserve(2 * boxes.size());
  if (!boxes.empty()) build(boxes);
}

std::uint32_t Blockers::build(std::span<Box> boxes) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Box all = kEmptyBox, centres = kEmptyBox;
  for (const Box& box : boxes) all.grow(box), centres.grow({centre(box), centre(box)});
  nodes_[index].box = all;
  if (boxes.size() == 1) return index;
  const Vec3 extent = centres.upper - centres.lower;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const auto middle = boxes.begin() + static_cast<std::ptrdiff_t>(boxes.size() / 2);
  std::nth_element(boxes.begin(), middle, boxes.end(),
                   [axis](const Box& a, const Box& b) { return centre(a)[axis] < centre(b)[axis]; });
  build(boxes.first(boxes.size() / 2));
  const std::uint32_t right = build(boxes.subspan(boxes.size() / 2));
  nodes_[index].right = right;
  return index;
}

void Blockers::in_shaft(const Box& a, const Box& b, std::vector<Box>& boxes) const {
  boxes.clear();
  if (nodes_.empty()) return;
  const BoxShaft shaft(a, b);
  std::array<std::uint32_t, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t index = stack[--depth];
    const Node& node = nodes_[index];
    if (!shaft.reaches(node.box, touching_)) continue;
    if (node.right == 0) {
      boxes.push_back(node.box);
    } else {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
    }
  }
}

PairShaft::PairShaft(std::span<const Vec3, 3> p, const Vec3& normal_p, std::span<const Vec3, 3> q, const Vec3& normal_q,
                     double touching)
    : touching_(touching) {
  hold(-normal_p, -dot(normal_p, p[0]));
  hold(-normal_q, -dot(normal_q, q[0]));
  bounds_ = Box::around(p);
  bounds_.grow(Box::around(q));
  const auto side_planes = [&](std::span<const Vec3, 3> edges, std::span<const Vec3, 3> corners) {
    for (std::size_t e = 0; e < 3; ++e) {
      const Vec3 start = edges[e], along = edges[(e + 1) % 3] - start, opposite = edges[(e + 2) % 3] - start;
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3 n = cross(along, corners[c] - start);
        const double h0 = dot(n, opposite), h1 = dot(n, corners[(c + 1) % 3] - start),
                     h2 = dot(n, corners[(c + 2) % 3] - start);
        // The plane holds the hull when its other three corners lie on one side of it.
        if (h0 <= 0 && h1 <= 0 && h2 <= 0) hold_scaled(n, start);
        else if (h0 >= 0 && h1 >= 0 && h2 >= 0) hold_scaled(-n, start);
      }
    }
  };
  side_planes(p, q);
  side_planes(q, p);
}

void PairShaft::hold_scaled(const Vec3& normal, const Vec3& point) {
  const double l = length(normal);
  if (l > 0) hold(normal / l, dot(normal, point) / l);
}

bool PairShaft::reaches(const Box& box) const {
  if (box.lower.x > bounds_.upper.x || box.upper.x < bounds_.lower.x || box.lower.y > bounds_.upper.y ||
      box.upper.y < bounds_.lower.y || box.lower.z > bounds_.upper.z || box.upper.z < bounds_.lower.z)
    return false;
  for (std::size_t k = 0; k < sides_; ++k)
    if (least_height(box, side_[k].normal) >= side_[k].offset - touching_) return false;
  return true;
}

}  // namespace clerestory
