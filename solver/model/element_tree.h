#pragma once
// One tree over all leaf elements, as flat arrays.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace clerestory {

/// V nodes in depth-first order over N leaves: one root, clusters, patches, halves of patches, leaf elements. A node's
/// subtree is the nodes v .. end[v] - 1, its first child v + 1, the next one end[v + 1]. Leaves are numbered in the
/// same order, so those under a node are in a row.
struct ElementTree {
  static constexpr std::uint32_t kNone = 0xffffffff;

  std::vector<std::uint32_t> end;            ///< V, first node behind the subtree
  std::vector<std::uint32_t> parent;         ///< V, kNone for the root
  std::vector<std::uint32_t> leaf_begin;     ///< V + 1, leaves before the node
  std::vector<double> area;                  ///< V [m2]
  std::vector<bool> cluster;                 ///< V, of more than one patch
  std::vector<bool> cut;                     ///< V, of one patch, cut and not halved, and so are all of its parts
  std::vector<std::uint32_t> patch;          ///< N, PatchId of each leaf
  std::vector<std::uint32_t> node_of_patch;  ///< N, leaf node by PatchId
  std::size_t clusters = 0;

  std::size_t size() const { return end.size(); }
  std::size_t leaf_count() const { return patch.size(); }
  bool is_leaf(std::uint32_t v) const { return end[v] == v + 1; }
  std::uint32_t first_leaf(std::uint32_t v) const { return leaf_begin[v]; }
  std::uint32_t leaf_end(std::uint32_t v) const { return leaf_begin[end[v]]; }
};

}  // namespace clerestory
