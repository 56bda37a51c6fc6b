#include "solver/hierarchy/element_mesh.h"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "solver/model/random_stream.h"
#include "solver/sampling/unit_square.h"
#include "tests/solver/hierarchy/field_scenes.h"

namespace clerestory {
namespace {

using testing::MeshedRoom;

/// Halves the leaves around a place, again and again: strongly graded.
void halve_around(ElementMesh& mesh, const Vec3& place, int times) {
  for (int k = 0; k < times; ++k) {
    std::vector<std::uint32_t> marked;
    for (const std::uint32_t leaf : mesh.leaves()) {
      const auto x = mesh.corner_positions(leaf);
      const Vec3 centre = (x[0] + x[1] + x[2]) / 3;
      if (length(centre - place) < 1.0 / (1 + k)) marked.push_back(leaf);
    }
    mesh.split(marked);
  }
}

class GradedRoom : public ::testing::Test {
 protected:
  GradedRoom() : room(testing::room_with_box(), 0.6), mesh(room.patches, room.map) {
    // A corner of the box on the floor, where three surfaces meet and the floor is parted.
    halve_around(mesh, Vec3{1, 1, 0} - room.patches.origin, 7);
    leaves = mesh.leaf_patches();
    map = std::move(mesh).leaf_lightmap();
  }
  MeshedRoom room;
  ElementMesh mesh;
  PatchSet leaves;
  VertexLightmap map;
};

TEST_F(GradedRoom, HasNoTVertices) {
  ASSERT_GT(leaves.patch_count(), room.patches.patch_count() + 100);
  EXPECT_EQ(testing::t_vertices(leaves), 0u);
  for (std::uint32_t p = 0; p < leaves.patch_count(); ++p)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t q = map.neighbour[p][k];
      if (q == VertexLightmap::kNone) continue;
      EXPECT_GE(std::count(map.neighbour[q].begin(), map.neighbour[q].end(), p), 1) << p << " and " << q;
    }
}

TEST(ElementMesh, IsSoundForOpenMeshsOwnChecker) {
  const MeshedRoom room(testing::room_with_box(), 0.6);
  ElementMesh mesh(room.patches, room.map);
  EXPECT_TRUE(mesh.is_sound());
  halve_around(mesh, Vec3{1, 1, 0} - room.patches.origin, 5);
  EXPECT_TRUE(mesh.is_sound());
}

TEST_F(GradedRoom, KeepsAreaAnglesAndOrientation) {
  EXPECT_NEAR(leaves.total_area(), room.patches.total_area(), 1e-9);
  double before = 4, after = 4;
  for (std::size_t p = 0; p < room.patches.patch_count(); ++p)
    before = std::min(before, testing::smallest_angle(room.patches.corner_positions(PatchId{p})));
  for (std::size_t p = 0; p < leaves.patch_count(); ++p) {
    const auto x = leaves.corner_positions(PatchId{p});
    const Vec3 n = cross(x[1] - x[0], x[2] - x[0]);
    EXPECT_NEAR(length(n) / 2, leaves.area[p], 1e-9);
    EXPECT_GT(dot(n, leaves.normal[p]), 0);
    after = std::min(after, testing::smallest_angle(x));
  }
  EXPECT_GT(after, before / 2 - 1e-9);  // Rivara's bound
}

TEST_F(GradedRoom, RaysMeetTheLeafThatHoldsThePoint) {
  int met = 0;
  for (std::uint32_t k = 0; k < 2000; ++k) {
    const auto u = sobol4(k, 1);
    const Vec3 from = Vec3{0.8, 0.8, 0.5} - room.patches.origin, d = sphere_direction(u[0], u[1]);
    const Hit hit = room.rays.first_hit(leaves, {from, d});
    ASSERT_TRUE(hit.patch.valid());
    const Vec3 at = from + d * hit.distance;
    const auto x = leaves.corner_positions(hit.patch);
    // Inside to within single precision: no barycentric weight below zero by more than the hit's rounding.
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 edge = x[(i + 1) % 3] - x[i], inward = cross(leaves.normal[hit.patch], edge);
      EXPECT_GT(dot(at - x[i], inward) / length(inward), -2e-5);
    }
    met += hit.patch.value >= room.patches.patch_count();
  }
  EXPECT_GT(met, 100);  // of them on elements numbered beyond the patches: some were halved
}

TEST_F(GradedRoom, SharesPointsWhereTheSurfaceIsSmoothAndNowhereElse) {
  // Every point of a leaf stands where the leaf's corner is; those of one point face the same way in a room of planes.
  std::vector<Vec3> facing(map.position.size());
  for (std::size_t p = 0; p < leaves.patch_count(); ++p) {
    const auto x = leaves.corner_positions(PatchId{p});
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t point = map.corners[p][k];
      EXPECT_LT(length(map.position[point] - x[k]), 1e-12);
      if (dot(facing[point], facing[point]) == 0) facing[point] = leaves.normal[p];
      EXPECT_GT(dot(facing[point], leaves.normal[p]), 0.999);
    }
  }
  // Neighbours in one plane share both ends of their edge.
  for (std::uint32_t p = 0; p < leaves.patch_count(); ++p)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t q = map.neighbour[p][k];
      if (q == VertexLightmap::kNone || dot(leaves.normal[p], leaves.normal[q]) < 0.999 ||
          leaves.material(PatchId{std::size_t{p}}) != leaves.material(PatchId{std::size_t{q}}))
        continue;
      for (const std::uint32_t point : {map.corners[p][k], map.corners[p][(k + 1) % 3]})
        EXPECT_TRUE(std::count(map.corners[q].begin(), map.corners[q].end(), point) == 1);
    }
}

TEST(ElementMesh, IsTheSameFromWhateverOrderOfMarks) {
  const MeshedRoom room(testing::room_with_box(), 0.6);
  ElementMesh forward(room.patches, room.map), backward(room.patches, room.map);
  std::vector<std::uint32_t> marked = forward.leaves();
  marked.resize(marked.size() / 3);
  forward.split(marked);
  std::reverse(marked.begin(), marked.end());
  backward.split(marked);
  const PatchSet a = forward.leaf_patches(), b = backward.leaf_patches();
  ASSERT_EQ(a.patch_count(), b.patch_count());
  for (std::size_t p = 0; p < a.patch_count(); ++p)
    EXPECT_EQ(a.corner_positions(PatchId{p}), b.corner_positions(PatchId{p}));
}

TEST(ElementMesh, OfNothingHalvedIsThePatches) {
  const MeshedRoom room(testing::room_with_box(), 0.6);
  const PatchSet same = ElementMesh(room.patches, room.map).leaf_patches();
  ASSERT_EQ(same.patch_count(), room.patches.patch_count());
  for (std::size_t p = 0; p < same.patch_count(); ++p) {
    EXPECT_EQ(same.corner_positions(PatchId{p}), room.patches.corner_positions(PatchId{p}));
    EXPECT_EQ(same.area[p], room.patches.area[p]);
    EXPECT_EQ(same.M[p], room.patches.M[p]);
  }
}

}  // namespace
}  // namespace clerestory
