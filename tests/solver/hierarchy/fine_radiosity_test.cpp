#include "solver/hierarchy/fine_radiosity.h"

#include <cmath>

#include <gtest/gtest.h>

#include "solver/hierarchy/vertex_field.h"
#include "tests/solver/hierarchy/field_scenes.h"

namespace clerestory {
namespace {

using testing::MeshedRoom;

/// Irradiance of the elements of a room when it is `light` at each place: means, of what is quadratic.
template <class Light>
Field means(const PatchSet& elements, const Light& light) {
  Field E(elements.patch_count(), 1);
  for (std::size_t i = 0; i < E.size(); ++i) {
    const auto x = elements.corner_positions(PatchId{i});
    E.set(i, Spectrum((light((x[0] + x[1]) / 2) + light((x[1] + x[2]) / 2) + light((x[2] + x[0]) / 2)) / 3));
  }
  return E;
}

/// Radiosity less what is emitted, at a place, where E are the means.
double reflected(const FineRadiosity& fine, const PatchSet& patches, const Field& E, std::size_t i, const Vec3& x) {
  return patches.rho[i][0] * E[i][0] + fine.above_mean(PatchId{i}, x)[0];
}

Vec3 within(const std::array<Vec3, 3>& x, double a, double b) { return x[0] * (1 - a - b) + x[1] * a + x[2] * b; }

TEST(FineRadiosity, IsLinearAcrossElementsAndKeepsTheirMeans) {
  const MeshedRoom room(testing::room_with_box(), 0.3);
  const PatchSet& patches = room.patches;
  const auto light = [](const Vec3& x) { return 20 + 3 * x.x - 2 * x.y + x.z; };
  const Field E = means(patches, light), none(E.size(), 1);
  const ElementMesh mesh(patches, room.map);
  const FineRadiosity fine(mesh, patches, E, none);
  double off = 0, off_by_means = 0, steps = 0;
  for (std::size_t i = 0; i < E.size(); ++i) {
    const auto x = patches.corner_positions(PatchId{i});
    const double rho = patches.rho[i][0];
    EXPECT_NEAR(fine.above_mean(PatchId{i}, within(x, 1. / 3, 1. / 3))[0], 0, 1e-5 * rho * E[i][0]);
    if (!(rho > 0)) continue;
    for (const double a : {0.05, 0.9}) {
      const Vec3 place = within(x, a, 0.05);
      off += std::abs(reflected(fine, patches, E, i, place) / rho - light(place)), ++steps;
      off_by_means += std::abs(E[i][0] - light(place));
    }
  }
  ASSERT_GT(steps, 100);
  EXPECT_LT(off, 0.25 * off_by_means) << "at the ends of surfaces all that is known lies to one side";
}

TEST(FineRadiosity, LeavesSunAndLuminairesAMean) {
  const MeshedRoom room(testing::room_with_box(), 0.3);
  const Field E = means(room.patches, [](const Vec3& x) { return 5 + x.x * x.x; });
  const ElementMesh mesh(room.patches, room.map);
  const FineRadiosity fine(mesh, room.patches, E, E);
  for (std::size_t i = 0; i < E.size(); ++i)
    for (const double a : {0.05, 0.9})
      EXPECT_EQ(fine.above_mean(PatchId{i}, within(room.patches.corner_positions(PatchId{i}), a, 0.05))[0], 0);
}

TEST(FineRadiosity, GoesBetweenTheVerticesOfHalvedElements) {
  const MeshedRoom room(testing::room_with_box(), 0.6);
  const PatchSet& patches = room.patches;
  const auto light = [](const Vec3& x) { return 4 + std::abs(x.x) + x.y * x.y; };
  const Field E = means(patches, light), none(E.size(), 1);
  ElementMesh mesh(patches, room.map);
  FineRadiosity fine(mesh, patches, E, none);
  for (int k = 0; k < 3; ++k) mesh.split(mesh.leaves());
  const std::size_t points = mesh.points().position.size();
  VertexField field;
  field.E = field.delta_light = Field(points, 1);
  field.known.assign(points, true);
  for (std::size_t p = 0; p < points; ++p) field.E.set(p, Spectrum(light(mesh.points().position[p])));
  const auto error = [&] {
    double off = 0;
    for (std::size_t i = 0; i < E.size(); ++i) {
      if (!(patches.rho[i][0] > 0)) continue;
      const Vec3 place = within(patches.corner_positions(PatchId{i}), 0.1, 0.2);
      off += std::abs(reflected(fine, patches, E, i, place) / patches.rho[i][0] - light(place));
    }
    return off;
  };
  const double by_elements = error();
  fine.take(field);
  EXPECT_LT(error(), 0.3 * by_elements);
  // Halved since, what was taken is what it was.
  const double taken = error();
  mesh.split(mesh.leaves());
  EXPECT_EQ(error(), taken);
}

TEST(FineRadiosity, IsNeverNegative) {
  const MeshedRoom room(testing::room_with_box(), 0.6);
  Field E(room.patches.patch_count(), 1);  // dark and bright in turn: what is linear would be negative
  for (std::size_t i = 0; i < E.size(); ++i) E.set(i, Spectrum(i % 3 == 0 ? 30 : 0.1));
  const ElementMesh mesh(room.patches, room.map);
  const FineRadiosity fine(mesh, room.patches, E, Field(E.size(), 1));
  for (std::size_t i = 0; i < E.size(); ++i)
    for (const double a : {0., 0.5, 1.})
      EXPECT_GE(reflected(fine, room.patches, E, i, within(room.patches.corner_positions(PatchId{i}), a, 0)), 0);
}

}  // namespace
}  // namespace clerestory
