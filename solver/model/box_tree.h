#pragma once
// A tree over bounding boxes that finds all boxes near something.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "solver/model/box.h"

namespace clerestory {

/// Boxes by number, kept.
struct StoredBoxes {
  std::vector<Box> boxes;
  const Box& operator()(std::uint32_t i) const { return boxes[i]; }
};

/// Static tree over boxes that box_of(i), i < n, gives: of millions of points or faces no box need be stored.
/// Boxes are put in the order of their centres' Morton codes, then halved by number. Visits in a fixed order, so what
/// is found does not depend on threads. Cost: O(n log n), 40 bytes a box.
template <class BoxOf>
class BoxTree {
 public:
  BoxTree(std::size_t n, BoxOf box_of) : box_of_(std::move(box_of)) {
    if (n == 0) return;
    sort(n);
    nodes_.reserve(2 * ((n + kLeaf / 2) / (kLeaf / 2)));
    build(0, static_cast<std::uint32_t>(n));
  }

  Box box(std::uint32_t i) const { return box_of_(i); }

  /// Calls found(index) for every box for which touches(box) holds; touches must hold for a box that contains such a
  /// box.
  template <class Touches, class Found>
  void visit_if(const Touches& touches, const Found& found) const {
    visit_if(touches, found, [](std::size_t) { return true; });
  }
  /// Passes over the nodes that are not open, and all below them.
  template <class Touches, class Found, class Open>
  void visit_if(const Touches& touches, const Found& found, const Open& is_open) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const std::uint32_t index = stack[--depth];
      const Node& node = nodes_[index];
      if (!is_open(index) || !touches(node.box())) continue;
      if (node.right == 0) {
        for (std::uint32_t k = node.begin; k < node.end; ++k)
          if (touches(box_of_(order_[k]))) found(order_[k]);
      } else {
        stack[depth++] = node.right;
        stack[depth++] = index + 1;
      }
    }
  }
  /// Numbers of the boxes so that neighbours in space mostly follow each other: queries in this order find in the cache
  /// what the last one left there.
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// For each node what its boxes make together: value_of(number) of each, joined two by two.
  template <class ValueOf, class Join>
  auto by_node(const ValueOf& value_of, const Join& join) const {
    std::vector<decltype(value_of(std::uint32_t{}))> values(nodes_.size());
    for (std::size_t n = nodes_.size(); n-- > 0;) {
      const Node& node = nodes_[n];
      if (node.right == 0) {
        values[n] = value_of(order_[node.begin]);
        for (std::uint32_t k = node.begin + 1; k < node.end; ++k) values[n] = join(values[n], value_of(order_[k]));
      } else {
        values[n] = join(values[n + 1], values[node.right]);
      }
    }
    return values;
  }
  /// Calls visit(node) for the nodes that hold the box at a place in order().
  template <class Visit>
  void visit_nodes_of(std::uint32_t place, const Visit& visit) const {
    for (std::uint32_t n = 0;;) {
      visit(n);
      const Node& node = nodes_[n];
      if (node.right == 0) return;
      n = place < nodes_[node.right].begin ? n + 1 : node.right;
    }
  }

  template <class Found>
  void visit(const Box& near, const Found& found) const {
    visit_if([&](const Box& b) { return b.touches(near); }, found);
  }

 private:
  static constexpr std::uint32_t kLeaf = 4;     ///< most boxes of a leaf
  static constexpr std::size_t kTogether = 64;  ///< as many boxes may have one code

  struct Node {
    std::array<float, 3> lower, upper;  ///< rounded outwards
    std::uint32_t begin, end;
    std::uint32_t right;  ///< 0: a leaf; the left child is the next node
    Box box() const { return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}}; }
  };

  static float rounded(double x, float towards) {
    const auto f = static_cast<float>(x);
    return (towards < 0 ? f > x : f < x) ? std::nextafter(f, towards) : f;
  }
  /// The low 21 bits of x, each followed by two zeros.
  static std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
  }

  void sort(std::size_t n) {
    order_.resize(n);
    std::iota(order_.begin(), order_.end(), 0u);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
    sort(0, n, keys);
  }
  /// Boxes that fall together beside the extent of all are sorted by their own: a small model beside a stray face.
  void sort(std::size_t begin, std::size_t end, std::vector<std::pair<std::uint64_t, std::uint32_t>>& keys) {
    Box centres;
    for (std::size_t k = begin; k < end; ++k) {
      const Box& b = box_of_(order_[k]);
      centres.add(b.lower + b.upper);
    }
    const Vec3 size = centres.upper - centres.lower;
    const double widest = std::max({size.x, size.y, size.z});
    if (!(widest > 0)) return;
    const double scale = 0x1fffff / widest;
    if (!std::isfinite(scale)) return;
    keys.resize(end - begin);
    for (std::size_t k = begin; k < end; ++k) {
      const Box& b = box_of_(order_[k]);
      const Vec3 d = (b.lower + b.upper - centres.lower) * scale;
      keys[k - begin] = {spread(static_cast<std::uint64_t>(d.x)) | spread(static_cast<std::uint64_t>(d.y)) << 1 |
                             spread(static_cast<std::uint64_t>(d.z)) << 2,
                         order_[k]};
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::pair<std::size_t, std::size_t>> together;
    for (std::size_t k = begin, first = begin; k < end; ++k) {
      order_[k] = keys[k - begin].second;
      const bool is_last = k + 1 == end || keys[k + 1 - begin].first != keys[k - begin].first;
      if (is_last && k + 1 - first > kTogether) together.push_back({first, k + 1});
      if (is_last) first = k + 1;
    }
    for (const auto& [from, to] : together) sort(from, to, keys);
  }

  Box build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t index = nodes_.size();
    nodes_.push_back({{}, {}, begin, end, 0});
    Box box;
    if (end - begin <= kLeaf) {
      for (std::uint32_t k = begin; k < end; ++k) box.add(box_of_(order_[k]));
    } else {
      const std::uint32_t middle = begin + (end - begin) / 2;
      box.add(build(begin, middle));
      nodes_[index].right = static_cast<std::uint32_t>(nodes_.size());
      box.add(build(middle, end));
    }
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      nodes_[index].lower[k] = rounded(box.lower[axis], -std::numeric_limits<float>::infinity());
      nodes_[index].upper[k] = rounded(box.upper[axis], std::numeric_limits<float>::infinity());
    }
    return box;
  }

  BoxOf box_of_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace clerestory
