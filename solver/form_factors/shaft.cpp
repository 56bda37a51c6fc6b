#include "solver/form_factors/shaft.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "solver/geometry/polygon.h"
#include "solver/model/disjoint_sets.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Least value of dot(normal, x) over the box.
double least_height(const Box& box, const Vec3& normal) {
  return normal.x * (normal.x > 0 ? box.lower.x : box.upper.x) + normal.y * (normal.y > 0 ? box.lower.y : box.upper.y) +
         normal.z * (normal.z > 0 ? box.lower.z : box.upper.z);
}

double& coordinate(Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// The convex hull of two boxes as half-spaces dot(normal, x) <= offset.
struct BoxShaft {
  Box bounds;
  std::array<Vec3, 12> normal;
  std::array<double, 12> offset;
  std::size_t sides = 0;

  BoxShaft(const Box& a, const Box& b) : bounds(a) {
    bounds.add(b);
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
        if (high <= here + slack)
          hold(n, high);
        else if (low >= here - slack)
          hold(-n, -low);
      }
    }
  }
  void hold(const Vec3& n, double o) { normal[sides] = n, offset[sides++] = o; }

  bool reaches(const Box& box, double touching) const {
    if (box.lower.x >= bounds.upper.x - touching || box.upper.x <= bounds.lower.x + touching ||
        box.lower.y >= bounds.upper.y - touching || box.upper.y <= bounds.lower.y + touching ||
        box.lower.z >= bounds.upper.z - touching || box.upper.z <= bounds.lower.z + touching)
      return false;
    for (std::size_t k = 0; k < sides; ++k)
      if (least_height(box, normal[k]) >= offset[k] - touching) return false;
    return true;
  }
};

std::array<Vec3, 3> corners_of(const PatchSet& patches, std::size_t t) {
  const auto& c = patches.corners[t];
  return {patches.vertices[c[0]], patches.vertices[c[1]], patches.vertices[c[2]]};
}

/// Corners of the convex hull of points in the plane of frame.t and frame.b, counter-clockwise around frame.n. Source:
/// Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979.
std::vector<Vec3> convex_hull(std::vector<Vec3> points, const Frame& frame) {
  const auto x = [&](const Vec3& p) { return dot(frame.t, p); };
  const auto y = [&](const Vec3& p) { return dot(frame.b, p); };
  std::ranges::sort(points, [&](const Vec3& a, const Vec3& b) { return x(a) != x(b) ? x(a) < x(b) : y(a) < y(b); });
  std::vector<Vec3> hull;
  const auto add = [&](const Vec3& p, std::size_t floor) {
    while (hull.size() >= floor + 2 && dot(frame.n, cross(hull.back() - hull[hull.size() - 2], p - hull.back())) <= 0)
      hull.pop_back();
    hull.push_back(p);
  };
  for (const Vec3& p : points) add(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto p = points.rbegin(); p != points.rend(); ++p) add(*p, lower);
  hull.pop_back();
  return hull;
}

}  // namespace

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
  for (std::size_t t = 0; t < patches.triangle_count(); ++t) {
    if (!blocks[t]) continue;
    const auto& c = patches.corners[t];
    Blocker b;
    for (std::size_t k = 0; k < 3; ++k) b.corner[k] = patches.vertices[c[k]];
    b.normal = normalized(cross(b.corner[1] - b.corner[0], b.corner[2] - b.corner[0]));
    b.offset = dot(b.normal, b.corner[0]);
    triangles_.push_back(b);
  }
  nodes_.reserve(2 * triangles_.size());
  if (!triangles_.empty()) build(0, triangles_.size());
  find_screens(patches, blocks);
}

void Blockers::find_screens(const PatchSet& patches, const std::vector<std::uint8_t>& blocks) {
  // Opaque blockers that share an edge and a plane belong together.
  struct SharedEdge {
    Vec3 low, high;
    std::size_t triangle;
  };
  const auto before = [](const Vec3& a, const Vec3& b) {
    return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
  };
  std::vector<SharedEdge> sides;
  std::vector<Vec3> normal(patches.triangle_count());
  for (std::size_t t = 0; t < patches.triangle_count(); ++t) {
    if (!blocks[t] || patches.front_material(TriangleId{t}).lets_rays_pass()) continue;
    const auto corner = corners_of(patches, t);
    normal[t] = normalized(vector_area(corner));
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = corner[k], &b = corner[(k + 1) % 3];
      sides.push_back(before(a, b) ? SharedEdge{a, b, t} : SharedEdge{b, a, t});
    }
  }
  std::ranges::sort(sides, [&](const SharedEdge& a, const SharedEdge& b) {
    if (a.low != b.low) return before(a.low, b.low);
    if (a.high != b.high) return before(a.high, b.high);
    return a.triangle < b.triangle;
  });
  DisjointSets joined(patches.triangle_count());
  for (std::size_t k = 1; k < sides.size(); ++k) {
    const SharedEdge &a = sides[k - 1], &b = sides[k];
    if (a.low == b.low && a.high == b.high && length(cross(normal[a.triangle], normal[b.triangle])) < 1e-9)
      joined.join(a.triangle, b.triangle);
  }
  std::map<std::size_t, std::vector<std::size_t>> groups;
  for (std::size_t t = 0; t < patches.triangle_count(); ++t)
    if (blocks[t] && !patches.front_material(TriangleId{t}).lets_rays_pass()) groups[joined.find(t)].push_back(t);
  for (const auto& [first, members] : groups) {
    const Frame frame(normal[first]);
    const double offset = dot(frame.n, patches.vertices[patches.corners[first][0]]);
    std::vector<Vec3> points;
    double area = 0;
    bool flat = true;
    for (const std::size_t t : members) {
      const auto corner = corners_of(patches, t);
      area += length(vector_area(corner));
      for (const Vec3& x : corner) {
        flat &= std::abs(dot(frame.n, x) - offset) <= touching_;
        points.push_back(x);
      }
    }
    const std::vector<Vec3> hull = convex_hull(points, frame);
    // Convex, and nowhere covered twice, when the triangles fill their hull.
    if (!flat || hull.size() < 3 || std::abs(length(vector_area(hull)) - area) > 1e-9 * area) continue;
    Screen screen;
    screen.normal = frame.n, screen.offset = offset, screen.box = Box::around(hull);
    for (std::size_t k = 0; k < hull.size(); ++k) {
      const Vec3 inward = cross(frame.n, normalized(hull[(k + 1) % hull.size()] - hull[k]));
      screen.edges.push_back({inward, dot(inward, hull[k])});
    }
    screens_.push_back(std::move(screen));
  }
}

void Blockers::screens_in_shaft(const Box& a, const Box& b, std::vector<const Screen*>& found) const {
  found.clear();
  const BoxShaft shaft(a, b);
  for (const Screen& screen : screens_)
    if (shaft.reaches(screen.box, touching_)) found.push_back(&screen);
}

bool Screen::hides(std::span<const Vec3, 3> p, std::span<const Vec3, 3> q, double touching) const {
  std::array<double, 3> over_p, over_q;
  for (std::size_t k = 0; k < 3; ++k) over_p[k] = dot(normal, p[k]) - offset, over_q[k] = dot(normal, q[k]) - offset;
  const auto all = [&](const std::array<double, 3>& heights, double side) {
    return heights[0] * side > touching && heights[1] * side > touching && heights[2] * side > touching;
  };
  if (!(all(over_p, 1) && all(over_q, -1)) && !(all(over_p, -1) && all(over_q, 1))) return false;
  // The crossings of all segments lie in the hull of the crossings of the nine between corners.
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const Vec3 x = p[i] + (q[j] - p[i]) * (over_p[i] / (over_p[i] - over_q[j]));
      for (const Edge& edge : edges)
        if (dot(edge.inward, x) - edge.offset <= touching) return false;
    }
  return true;
}

std::uint32_t Blockers::build(std::size_t begin, std::size_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  const auto triangles = std::span(triangles_).subspan(begin, end - begin);
  Box all, centres;
  for (const Blocker& b : triangles) {
    const Box box = Box::around(b.corner);
    all.add(box), centres.add(box.centre());
  }
  nodes_[index].box = all;
  if (triangles.size() == 1) {
    nodes_[index].blocker = static_cast<std::uint32_t>(begin);
    return index;
  }
  const Vec3 extent = centres.upper - centres.lower;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::size_t half = triangles.size() / 2;
  std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(half), triangles.end(),
                   [axis](const Blocker& a, const Blocker& b) {
                     return Box::around(a.corner).centre()[axis] < Box::around(b.corner).centre()[axis];
                   });
  build(begin, begin + half);
  const std::uint32_t right = build(begin + half, end);
  nodes_[index].right = right;
  return index;
}

void Blockers::in_shaft(const Box& a, const Box& b, std::vector<const Blocker*>& found) const {
  found.clear();
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
      found.push_back(&triangles_[node.blocker]);
    } else {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
    }
  }
}

PairShaft::PairShaft(std::span<const Vec3, 3> p, const Vec3& normal_p, std::span<const Vec3, 3> q, const Vec3& normal_q,
                     double touching)
    : corner_{p[0], p[1], p[2], q[0], q[1], q[2]}, touching_(touching) {
  hold(-normal_p, -dot(normal_p, p[0]));
  hold(-normal_q, -dot(normal_q, q[0]));
  bounds_ = Box::around(p);
  bounds_.add(Box::around(q));
  const auto side_planes = [&](std::span<const Vec3, 3> edges, std::span<const Vec3, 3> corners) {
    for (std::size_t e = 0; e < 3; ++e) {
      const Vec3 start = edges[e], along = edges[(e + 1) % 3] - start, opposite = edges[(e + 2) % 3] - start;
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3 n = cross(along, corners[c] - start);
        const double h0 = dot(n, opposite), h1 = dot(n, corners[(c + 1) % 3] - start),
                     h2 = dot(n, corners[(c + 2) % 3] - start);
        // The plane holds the hull when its other three corners lie on one side of it.
        const double l = length(n), slack = l * touching_;
        if (l <= 1e-9 * dot(along, along)) continue;  // the corner lies on the edge's line: no plane
        if (h0 <= slack && h1 <= slack && h2 <= slack)
          hold(n / l, dot(n, start) / l);
        else if (h0 >= -slack && h1 >= -slack && h2 >= -slack)
          hold(-n / l, -dot(n, start) / l);
      }
    }
  };
  side_planes(p, q);
  side_planes(q, p);
}

bool PairShaft::reached_by(const Blocker& blocker) const {
  const auto& [a, b, c] = blocker.corner;
  if (std::max({a.x, b.x, c.x}) < bounds_.lower.x || std::min({a.x, b.x, c.x}) > bounds_.upper.x ||
      std::max({a.y, b.y, c.y}) < bounds_.lower.y || std::min({a.y, b.y, c.y}) > bounds_.upper.y ||
      std::max({a.z, b.z, c.z}) < bounds_.lower.z || std::min({a.z, b.z, c.z}) > bounds_.upper.z)
    return false;
  for (std::size_t k = 0; k < sides_; ++k) {
    const auto& [normal, offset] = side_[k];
    if (std::min({dot(normal, a), dot(normal, b), dot(normal, c)}) >= offset - touching_) return false;
  }
  bool above = false, below = false;
  for (const Vec3& x : corner_) {
    const double height = dot(blocker.normal, x) - blocker.offset;
    above |= height > touching_, below |= height < -touching_;
  }
  return above && below;
}

}  // namespace clerestory
