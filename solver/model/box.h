#pragma once
// Axis-parallel boxes.

#include <algorithm>
#include <limits>
#include <span>

#include "solver/model/vec.h"

namespace clerestory {

/// Empty until something is added: it touches nothing then.
struct Box {
  static constexpr double kHuge = std::numeric_limits<double>::infinity();
  Vec3 lower{kHuge, kHuge, kHuge}, upper{-kHuge, -kHuge, -kHuge};

  static Box around(std::span<const Vec3> points) {
    Box box;
    for (const Vec3& p : points) box.add(p);
    return box;
  }
  void add(const Vec3& p) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
  }
  void add(const Box& b) {
    add(b.lower);
    add(b.upper);
  }
  Vec3 centre() const { return (lower + upper) * 0.5; }
  Box grown(double by) const {
    Box b = *this;
    b.lower -= Vec3{by, by, by};
    b.upper += Vec3{by, by, by};
    return b;
  }
  bool contains(const Vec3& p) const {
    return lower.x <= p.x && p.x <= upper.x && lower.y <= p.y && p.y <= upper.y && lower.z <= p.z && p.z <= upper.z;
  }
  bool touches(const Box& b) const {
    return lower.x <= b.upper.x && b.lower.x <= upper.x && lower.y <= b.upper.y && b.lower.y <= upper.y &&
           lower.z <= b.upper.z && b.lower.z <= upper.z;
  }
  /// Whether the segment from a to b passes through the box (slab test).
  bool touches_segment(const Vec3& a, const Vec3& b) const {
    double enter = 0, leave = 1;
    for (int k = 0; k < 3; ++k) {
      const double d = b[k] - a[k];
      if (d == 0) {
        if (a[k] < lower[k] || a[k] > upper[k]) return false;
        continue;
      }
      const double s = (lower[k] - a[k]) / d, t = (upper[k] - a[k]) / d;
      enter = std::max(enter, std::min(s, t));
      leave = std::min(leave, std::max(s, t));
    }
    return enter <= leave;
  }
};

}  // namespace clerestory
