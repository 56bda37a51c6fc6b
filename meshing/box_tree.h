#pragma once
// Bounding boxes, and a tree over them that finds all boxes near something.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

struct Box {
  Vec3 lower{kHuge, kHuge, kHuge}, upper{-kHuge, -kHuge, -kHuge};
  static constexpr double kHuge = std::numeric_limits<double>::infinity();

  void add(const Vec3& p) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
  }
  void add(const Box& b) {
    add(b.lower);
    add(b.upper);
  }
  Box grown(double by) const {
    Box b = *this;
    b.lower -= Vec3{by, by, by};
    b.upper += Vec3{by, by, by};
    return b;
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

/// Static tree, built in O(n log n). Visits in a fixed order, so what is found does not depend on threads.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!boxes_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
  }

  /// Calls found(index) for every box for which touches(box) holds; touches must hold for a box that contains such a
  /// box.
  template <class Touches, class Found>
  void visit_if(const Touches& touches, const Found& found) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (!touches(node.box)) continue;
      if (node.right == 0) {
        for (std::uint32_t k = node.begin; k < node.end; ++k)
          if (touches(boxes_[order_[k]])) found(order_[k]);
      } else {
        stack[depth++] = node.right;
        stack[depth++] = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
      }
    }
  }
  template <class Found>
  void visit(const Box& near, const Found& found) const {
    visit_if([&](const Box& b) { return b.touches(near); }, found);
  }

 private:
  struct Node {
    Box box;
    std::uint32_t begin = 0, end = 0;
    std::uint32_t right = 0;  ///< 0: a leaf; the left child is the next node
  };

  std::uint32_t build(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    Box box, centres;
    for (std::uint32_t k = begin; k < end; ++k) {
      box.add(boxes_[order_[k]]);
      centres.add(boxes_[order_[k]].lower + boxes_[order_[k]].upper);
    }
    nodes_[index].box = box;
    nodes_[index].begin = begin;
    nodes_[index].end = end;
    if (end - begin <= 4) return index;
    const Vec3 d = centres.upper - centres.lower;
    const int axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t i, std::uint32_t j) {
                       const double ci = boxes_[i].lower[axis] + boxes_[i].upper[axis];
                       const double cj = boxes_[j].lower[axis] + boxes_[j].upper[axis];
                       return ci != cj ? ci < cj : i < j;
                     });
    build(begin, middle);
    const std::uint32_t right = build(middle, end);
    nodes_[index].right = right;
    return index;
  }

  std::vector<Box> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace clerestory
