#include "solver/hierarchy/build_tree.h"

#include <gtest/gtest.h>

#include "solver/hierarchy/element_mesh.h"
#include "solver/hierarchy/gather_links.h"
#include "tests/support/unjoined_lightmap.h"

namespace clerestory {
namespace {

void expect_sound(const ElementTree& tree, const PatchSet& patches) {
  ASSERT_EQ(tree.leaf_count(), patches.patch_count());
  EXPECT_EQ(tree.end[0], tree.size()) << "one root";
  EXPECT_NEAR(tree.area[0], patches.total_area(), 1e-9 * patches.total_area());
  std::vector<int> seen(patches.patch_count(), 0);
  std::size_t clusters = 0;
  for (std::uint32_t v = 0; v < tree.size(); ++v) {
    clusters += tree.cluster[v];
    if (tree.is_leaf(v)) {
      ++seen[tree.patch[tree.first_leaf(v)]];
      EXPECT_EQ(tree.node_of_patch[tree.patch[tree.first_leaf(v)]], v);
      continue;
    }
    double area = 0;
    std::uint32_t next_leaf = tree.first_leaf(v);
    for (std::uint32_t c = v + 1; c < tree.end[v]; c = tree.end[c]) {
      EXPECT_EQ(tree.parent[c], v);
      EXPECT_EQ(tree.first_leaf(c), next_leaf) << "leaves of a node are in a row";
      next_leaf = tree.leaf_end(c);
      area += tree.area[c];
    }
    EXPECT_EQ(next_leaf, tree.leaf_end(v));
    EXPECT_NEAR(area, tree.area[v], 1e-12 * tree.area[v]);
  }
  for (const int times : seen) EXPECT_EQ(times, 1) << "every leaf once";
  EXPECT_EQ(clusters, tree.clusters);
}

TEST(BuildTree, LeavesAreInARowAndAreasAddUpToOneRoot) {
  const PatchSet patches = test::room_of_2160_patches().build();
  expect_sound(build_tree(patches, patches.M), patches);
}

TEST(BuildTree, HalvesStandBelowTheirPatch) {
  const PatchSet patches = test::RoomWithBlocks{.room_cells = {3, 3, 2}, .block_cells = 1}.build();
  const VertexLightmap map = test::unjoined_lightmap(patches);
  ElementMesh mesh(patches, map);
  const std::vector<std::uint32_t> some{3, 7, 8};
  mesh.split(some);
  const std::vector<std::uint32_t> again{mesh[3].first};
  mesh.split(again);
  const PatchSet leaves = mesh.leaf_patches();
  const ElementTree tree = build_tree(leaves, leaves.M);
  expect_sound(tree, leaves);
  for (std::uint32_t v = 0; v < tree.size(); ++v)
    if (!tree.cluster[v] && !tree.is_leaf(v)) {
      // Halves are halves, and lie in one plane.
      EXPECT_NEAR(tree.area[v + 1], tree.area[v] / 2, 1e-12);
      for (std::uint32_t l = tree.first_leaf(v); l < tree.leaf_end(v); ++l)
        EXPECT_EQ(leaves.normal[tree.patch[l]], leaves.normal[tree.patch[tree.first_leaf(v)]]);
    }
}

TEST(BuildTree, ALampStandsApart) {
  test::PatchBuilder b(0.5);
  b.box({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 3}, {8, 8, 6}, true);
  b.material(0.5, 100).rectangle({1.9, 1.9, 2.9}, {0, 0.2, 0}, {0.2, 0, 0}, 2, 2);
  const PatchSet patches = b.build();
  const ElementTree tree = build_tree(patches, patches.M);
  // Eight patches glow: the smallest node with all of them holds nothing else.
  std::size_t smallest = patches.patch_count();
  for (std::uint32_t v = 0; v < tree.size(); ++v) {
    std::size_t glowing = 0;
    for (std::uint32_t l = tree.first_leaf(v); l < tree.leaf_end(v); ++l) glowing += patches.M[tree.patch[l]][0] > 0;
    if (glowing == 8) smallest = std::min<std::size_t>(smallest, tree.leaf_end(v) - tree.first_leaf(v));
  }
  EXPECT_EQ(smallest, 8u);
}

TEST(Pull, GivesMeansAndDeviationsOverTheArea) {
  const PatchSet patches = test::RoomWithBlocks{.room_cells = {5, 4, 3}, .block_cells = 2}.build();
  Field B(patches.patch_count(), 1);
  for (std::size_t i = 0; i < B.size(); ++i) B.at(i, 0) = static_cast<double>(i % 7);
  const ElementTree tree = build_tree(patches, B);
  const NodeLight light = node_light(tree, B);
  for (std::uint32_t v = 0; v < tree.size(); v += 5) {
    double sum = 0, squares = 0;
    for (std::uint32_t l = tree.first_leaf(v); l < tree.leaf_end(v); ++l) {
      const double a = patches.area[tree.patch[l]], x = B[tree.patch[l]][0];
      sum += a * x, squares += a * x * x;
    }
    const double mean = sum / tree.area[v], variance = squares / tree.area[v] - mean * mean;
    EXPECT_NEAR(double{light.mean[v]}, mean, 1e-5);  // float
    EXPECT_NEAR(double{light.deviation[v]}, std::sqrt(std::max(0.0, variance)), 1e-5);
  }
}

}  // namespace
}  // namespace clerestory
