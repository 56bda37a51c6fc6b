#include "solver/hierarchy/build_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/model/parallel.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr std::size_t kDimensions = 7;           // place, normal, brightness
constexpr float kNormal = 0.3f, kBright = 0.4f;  // weights against place
constexpr std::size_t kTogether = 4;             // patches in a cluster that is not split
constexpr std::size_t kFew = 256;                // patches that are split at a gap

/// A patch as clusters see it.
struct Item {
  std::array<float, kDimensions> at;
  std::uint32_t root;  ///< in PatchSet::splits, or the PatchId
};

/// Nodes of `splits` that are patches never halved from others.
std::size_t root_count(const PatchSet& patches) {
  std::size_t roots = patches.splits.size();
  for (const SplitNode& s : patches.splits)
    if (s.first_part != SplitNode::kNone) roots = std::min<std::size_t>(roots, s.first_part);
  return roots;
}

class Builder {
 public:
  Builder(const PatchSet& patches, const Field& B) : patches_(patches), B_(B) {}

  ElementTree build() {
    make_items();
    const std::size_t n = patches_.patch_count(), halvings = patches_.splits.empty() ? 0 : n - items_.size();
    const std::size_t expected = n + halvings + items_.size() / 2 + 16;
    tree_.end.reserve(expected), tree_.parent.reserve(expected), tree_.leaf_begin.reserve(expected + 1);
    tree_.area.reserve(expected);
    tree_.patch.reserve(n);
    tree_.node_of_patch.resize(n);
    if (!items_.empty()) add_cluster(0, items_.size(), ElementTree::kNone);
    tree_.leaf_begin.push_back(static_cast<std::uint32_t>(tree_.patch.size()));
    return std::move(tree_);
  }

 private:
  /// Calls leaf(PatchId) for all leaves under a patch, in their order.
  template <class Leaf>
  void for_leaves(std::uint32_t node, const Leaf& leaf) const {
    if (patches_.splits.empty()) return leaf(PatchId{std::size_t{node}});
    const SplitNode& s = patches_.splits[node];
    if (s.first_part == SplitNode::kNone) return leaf(PatchId{std::size_t{s.patch}});
    for_leaves(s.first_part, leaf);
    for_leaves(s.first_part + 1, leaf);
  }

  void make_items() {
    items_.resize(patches_.splits.empty() ? patches_.patch_count() : root_count(patches_));
    double flux = 0, area = 0;
    for (std::size_t i = 0; i < patches_.patch_count(); ++i)
      flux += patches_.area[i] * luminous_mean(B_[i]), area += patches_.area[i];
    const double mean = flux > 0 ? flux / area : 1;
    parallel_for(items_.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        Vec3 centre, normal;
        double weight = 0, light = 0;
        for_leaves(static_cast<std::uint32_t>(k), [&](PatchId p) {
          const auto c = patches_.corner_positions(p);
          const double a = patches_.area[p];
          centre += (c[0] + c[1] + c[2]) * (a / 3), weight += a, light += a * luminous_mean(B_[p]);
          normal = patches_.normal[p];
        });
        Item& item = items_[k];
        item.root = static_cast<std::uint32_t>(k);
        for (int axis = 0; axis < 3; ++axis) {
          item.at[static_cast<std::size_t>(axis)] = static_cast<float>(centre[axis] / weight);
          item.at[static_cast<std::size_t>(axis) + 3] = static_cast<float>(normal[axis]);
        }
        item.at[6] = static_cast<float>(std::log1p(std::max(0.0, light / weight / mean)));
      }
    });
  }

  std::uint32_t open(std::uint32_t parent, bool cluster) {
    const auto node = static_cast<std::uint32_t>(tree_.end.size());
    tree_.end.push_back(node + 1);
    tree_.parent.push_back(parent);
    tree_.leaf_begin.push_back(static_cast<std::uint32_t>(tree_.patch.size()));
    tree_.area.push_back(0);
    tree_.cluster.push_back(cluster);
    tree_.cut.push_back(false);
    tree_.clusters += cluster;
    return node;
  }
  double close(std::uint32_t node, double area) {
    tree_.end[node] = static_cast<std::uint32_t>(tree_.end.size());
    tree_.area[node] = area;
    return area;
  }

  double add_surface(std::uint32_t split, std::uint32_t parent) {
    const std::uint32_t node = open(parent, false);
    if (!patches_.splits.empty() && patches_.splits[split].first_part != SplitNode::kNone) {
      const std::uint32_t half = patches_.splits[split].first_part;
      double area = add_surface(half, node);
      const auto second = static_cast<std::uint32_t>(tree_.end.size());
      area += add_surface(half + 1, node);
      const auto is_whole_or_cut = [&](std::uint32_t v) { return tree_.end[v] == v + 1 || tree_.cut[v]; };
      tree_.cut[node] = patches_.splits[split].is_cut() && is_whole_or_cut(node + 1) && is_whole_or_cut(second);
      return close(node, area);
    }
    const std::uint32_t patch = patches_.splits.empty() ? split : patches_.splits[split].patch;
    tree_.patch.push_back(patch);
    tree_.node_of_patch[patch] = node;
    return close(node, patches_.area[patch]);
  }

  double add_cluster(std::size_t begin, std::size_t end, std::uint32_t parent) {
    if (end - begin == 1) return add_surface(items_[begin].root, parent);
    const std::uint32_t node = open(parent, true);
    double area = 0;
    if (end - begin <= kTogether) {
      for (std::size_t k = begin; k < end; ++k) area += add_surface(items_[k].root, node);
    } else {
      const std::size_t middle = split(begin, end);
      area = add_cluster(begin, middle, node);
      area += add_cluster(middle, end, node);
    }
    return close(node, area);
  }

  std::size_t split(std::size_t begin, std::size_t end) {
    std::array<float, kDimensions> low, high;
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    for (std::size_t k = begin; k < end; ++k)
      for (std::size_t d = 0; d < kDimensions; ++d)
        low[d] = std::min(low[d], items_[k].at[d]), high[d] = std::max(high[d], items_[k].at[d]);
    const float size = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    std::size_t widest = 0;
    float most = -1;
    for (std::size_t d = 0; d < kDimensions; ++d) {
      const float spread = (high[d] - low[d]) * (d < 3 ? 1 : (d < 6 ? kNormal : kBright) * size);
      if (spread > most) most = spread, widest = d;
    }
    const auto at = [&](std::size_t k) { return items_.begin() + static_cast<std::ptrdiff_t>(k); };
    if (widest == 6) {
      const float centre = (low[6] + high[6]) / 2;
      const auto bright = std::partition(at(begin), at(end), [&](const Item& i) { return i.at[6] < centre; });
      const auto middle = static_cast<std::size_t>(bright - items_.begin());
      if (middle > begin && middle < end) return middle;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const auto before = [&](const Item& a, const Item& b) {
      return a.at[widest] < b.at[widest] || (a.at[widest] == b.at[widest] && a.root < b.root);
    };
    if (end - begin > kFew) {
      std::nth_element(at(begin), at(middle), at(end), before);
      return middle;
    }
    // Between things, not through them.
    std::sort(at(begin), at(end), before);
    std::size_t best = middle;
    const auto gap = [&](std::size_t k) { return items_[k].at[widest] - items_[k - 1].at[widest]; };
    for (std::size_t k = begin + (end - begin + 7) / 8; k <= end - (end - begin + 7) / 8; ++k)
      if (gap(k) > 1.01f * gap(best)) best = k;
    return best;
  }

  const PatchSet& patches_;
  const Field& B_;
  std::vector<Item> items_;
  ElementTree tree_;
};

}  // namespace

ElementTree build_tree(const PatchSet& patches, const Field& B) { return Builder(patches, B).build(); }

std::vector<Sphere> bounding_spheres(const ElementTree& tree, const PatchSet& patches) {
  struct Box {
    std::array<float, 3> low, high;
  };
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<Box> box(tree.size(), {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}});
  for (std::size_t v = tree.size(); v-- > 0;) {  // children before their parents
    if (tree.is_leaf(static_cast<std::uint32_t>(v)))
      for (const Vec3& c : patches.corner_positions(PatchId{std::size_t{tree.patch[tree.leaf_begin[v]]}}))
        for (int axis = 0; axis < 3; ++axis) {
          const auto k = static_cast<std::size_t>(axis);
          box[v].low[k] = std::min(box[v].low[k], static_cast<float>(c[axis]));
          box[v].high[k] = std::max(box[v].high[k], static_cast<float>(c[axis]));
        }
    if (tree.parent[v] == ElementTree::kNone) continue;
    Box& above = box[tree.parent[v]];
    for (std::size_t k = 0; k < 3; ++k) {
      above.low[k] = std::min(above.low[k], box[v].low[k]);
      above.high[k] = std::max(above.high[k], box[v].high[k]);
    }
  }
  std::vector<Sphere> sphere(tree.size());
  for (std::size_t v = 0; v < tree.size(); ++v) {
    const Box& b = box[v];
    for (std::size_t k = 0; k < 3; ++k) sphere[v].centre[k] = (b.low[k] + b.high[k]) / 2;
    sphere[v].radius = std::hypot(b.high[0] - b.low[0], b.high[1] - b.low[1], b.high[2] - b.low[2]) / 2;
  }
  return sphere;
}

}  // namespace clerestory
