#include "solver/hierarchy/leaf_errors.h"

#include <map>

#include <gtest/gtest.h>

#include "tests/solver/hierarchy/field_scenes.h"

namespace clerestory {
namespace {

using testing::MeshedRoom;

VertexField field_at_points(const ElementMesh& mesh) {
  const auto& x = mesh.points().position;
  VertexField field;
  field.E = field.delta_light = Field(x.size(), 1);
  field.std_error.assign(x.size(), 0.1);
  field.known.assign(x.size(), true);
  for (std::size_t p = 0; p < x.size(); ++p)
    field.E.set(p, Spectrum(6 + x[p].x * x[p].y + (x[p].x > 0.3 ? 2 * x[p].z : 0)));
  return field;
}

TEST(LeafErrors, OfChangedAreThoseOfAFreshLook) {
  const MeshedRoom room(testing::room_with_box(), 0.5);
  ElementMesh mesh(room.patches, room.map);
  VertexField field = field_at_points(mesh);
  LeafErrors errors(mesh, field);
  std::map<std::uint32_t, LeafError> known;
  for (const LeafError& e : errors.of_changed()) known[e.leaf] = e;
  ASSERT_EQ(known.size(), mesh.leaf_count());
  for (int round = 0; round < 4; ++round) {
    const std::vector<std::uint32_t> leaves = mesh.leaves();
    const std::size_t some = leaves.size() / 40;
    mesh.split(std::span(leaves).subspan(some * static_cast<std::size_t>(round), some));
    field = field_at_points(mesh);
    const std::vector<LeafError> changed = errors.of_changed();
    EXPECT_LT(changed.size(), mesh.leaf_count() / 2);
    for (const LeafError& e : changed) known[e.leaf] = e;
    for (const LeafError& fresh : LeafErrors(mesh, field).of_changed()) {
      ASSERT_TRUE(known.contains(fresh.leaf));
      const LeafError& e = known[fresh.leaf];
      EXPECT_NEAR(e.off, fresh.off, 1e-12);
      EXPECT_NEAR(e.soft, fresh.soft, 1e-12);
      EXPECT_NEAR(e.E, fresh.E, 1e-12);
      EXPECT_EQ(e.std_error, fresh.std_error);
    }
  }
}

TEST(LeafErrors, LeavesOutWhatWasNotGathered) {
  const MeshedRoom room(testing::room_with_box(), 0.5);
  const ElementMesh mesh(room.patches, room.map);
  VertexField field = field_at_points(mesh);
  field.known[mesh.points_of(3)[1]] = false;
  for (const LeafError& e : LeafErrors(mesh, field).of_changed())
    for (const std::uint32_t p : mesh.points_of(e.leaf)) EXPECT_TRUE(field.known[p]);
}

}  // namespace
}  // namespace clerestory
