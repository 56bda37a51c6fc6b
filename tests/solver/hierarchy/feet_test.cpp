#include "solver/hierarchy/feet.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "solver/hierarchy/vertex_field.h"
#include "tests/solver/hierarchy/field_scenes.h"
#include "tests/support/gather_quality.h"

namespace clerestory {
namespace {

using testing::MeshedRoom;

/// Legs of 5 cm in elements of 60 cm: no vertex but at their corners.
constexpr double kSide = 0.05;
constexpr std::array<Vec3, 2> kLegs{Vec3{3, 2, 0}, Vec3{1, 2.2, 0}};

testing::SceneMaker room_with_legs() {
  testing::SceneMaker maker = testing::room_with_box();
  for (const Vec3& leg : kLegs) maker.box(leg, leg + Vec3{kSide, kSide, 0.7});
  return maker;
}

TEST(CutAtFeet, LegsAndBoxesGetVerticesBetweenTheirCorners) {
  const MeshedRoom room(room_with_legs(), 0.6);
  ElementMesh mesh(room.patches, room.map);
  const double area = room.patches.total_area();
  // Four sides of each leg, three cuts each; no more of the box, of which the sides are longer than elements.
  const std::size_t cut = cut_at_feet(mesh, 0.04, 0.25);
  EXPECT_GE(cut, 2u * 4 * 3);
  EXPECT_LE(cut, 3u * 4 * 3);
  EXPECT_TRUE(mesh.is_sound());
  const PatchSet leaves = mesh.leaf_patches();
  EXPECT_NEAR(leaves.total_area(), area, 1e-9);
  EXPECT_EQ(testing::t_vertices(leaves), 0u);
  for (const Vec3& leg : kLegs) {
    const Vec3 middle = leg + Vec3{kSide / 2, 0, 0} - room.patches.origin;
    EXPECT_GE(std::ranges::count_if(leaves.vertices, [&](const Vec3& v) { return length(v - middle) < 1e-6; }), 1);
  }
}

TEST(CutAtFeet, NoneThatIsShorterThanAllowed) {
  const MeshedRoom room(room_with_legs(), 0.6);
  ElementMesh mesh(room.patches, room.map);
  const std::size_t before = mesh.leaf_count();
  EXPECT_EQ(cut_at_feet(mesh, 10, 1), 0u);
  EXPECT_EQ(mesh.leaf_count(), before);
}

TEST(CutAtFeet, WhatTheFieldShowsBesideALegIsDarkerThanAtItsCorners) {
  // The room's walls glow alike: beside a leg half of the view is gone, at its corners a quarter.
  const MeshedRoom room(room_with_legs(), 0.6);
  ElementMesh mesh(room.patches, room.map);
  Field B(room.patches.patch_count(), 1);
  for (std::size_t p = 0; p < B.size(); ++p) {
    const auto x = room.patches.corner_positions(PatchId{p});
    const Vec3 c = (x[0] + x[1] + x[2]) / 3 + room.patches.origin;
    const bool is_wall = c.x < 1e-6 || c.x > 4 - 1e-6 || c.y < 1e-6 || c.y > 3 - 1e-6;
    B.set(p, Spectrum(is_wall ? 3 : 0));
  }
  const VertexField field =
      gather_field(room.problem(), B, mesh,
                   {.tolerance = 0.05, .shortest_edge = 0.04, .quality = test::gather_quality({16, 256, 256}, 64)});
  const Vec3 corner = kLegs[0] - room.patches.origin, middle = corner + Vec3{kSide / 2, 0, 0};
  const auto E_at = [&](const Vec3& place) {
    for (const std::uint32_t leaf : mesh.leaves()) {
      if (room.patches.normal[mesh[leaf].patch].z < 0.5) continue;
      const auto x = mesh.corner_positions(leaf);
      for (std::size_t k = 0; k < 3; ++k)
        if (length(x[k] - place) < 1e-6) return field.E[mesh.points_of(leaf)[k]][0];
    }
    return -1.0;
  };
  ASSERT_GT(E_at(corner), 0);
  ASSERT_GT(E_at(middle), 0) << "a vertex";
  EXPECT_LT(E_at(middle), E_at(corner));
}

}  // namespace
}  // namespace clerestory
