#include "solver/hierarchy/receivers.h"

#include "solver/hierarchy/build_tree.h"

namespace clerestory {
namespace {

/// Whether v is a cluster of few patches that see one space, none of which was worth halving.
bool is_small(const ElementTree& tree, const PatchSet& patches, std::uint32_t v) {
  if (tree.leaf_end(v) - tree.first_leaf(v) > kMostMembers) return false;
  if (!patches.space.empty())
    for (std::uint32_t leaf = tree.first_leaf(v); leaf < tree.leaf_end(v); ++leaf)
      if (patches.space[tree.patch[leaf]] != patches.space[tree.patch[tree.first_leaf(v)]]) return false;
  for (std::uint32_t below = v; below < tree.end[v]; ++below)
    if (!tree.is_leaf(below) && !tree.cluster[below] && !tree.cut[below]) return false;
  return true;
}

std::vector<Receiver> within(double diameter, const ElementTree& tree, const PatchSet& patches,
                             const std::vector<Sphere>& spheres) {
  std::vector<Receiver> receivers;
  for (std::uint32_t v = 0; v < tree.size();) {
    const bool surface = tree.is_leaf(v) || (tree.cut[v] && tree.leaf_end(v) - tree.first_leaf(v) <= kMostMembers);
    if (surface || (diameter > 0 && 2 * spheres[v].radius <= diameter && is_small(tree, patches, v))) {
      receivers.push_back({tree.first_leaf(v), tree.leaf_end(v), 1, !surface});
      v = tree.end[v];
    } else {
      ++v;
    }
  }
  return receivers;
}

}  // namespace

std::vector<Receiver> choose_receivers(const ElementTree& tree, const PatchSet& patches, double diameter,
                                       std::size_t most) {
  if (!(diameter > 0)) return within(0, tree, patches, {});
  const std::vector<Sphere> spheres = bounding_spheres(tree, patches);
  std::vector<Receiver> receivers = within(diameter, tree, patches, spheres);
  while (receivers.size() > most && diameter < 2 * spheres[0].radius)
    receivers = within(diameter *= 1.5, tree, patches, spheres);
  return receivers;
}

}  // namespace clerestory
