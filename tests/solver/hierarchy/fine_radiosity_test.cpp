#include "solver/hierarchy/fine_radiosity.h"

#include <cmath>

#include <gtest/gtest.h>

#include "solver/gather/gather_point.h"
#include "solver/hierarchy/vertex_field.h"
#include "tests/solver/hierarchy/field_scenes.h"
#include "tests/support/gather_quality.h"

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

TEST(FineRadiosity, KeepsTheMeansOfElementsBetweenVerticesInThreeChannels) {
  // Cut, and halved; with light of luminaires, which stays even; dark corners beside bright ones.
  MeshedRoom room(testing::room_with_box(), 0.6);
  room.patches.channels = 3;
  Field rho(room.patches.patch_count(), 3), E(rho.size(), 3), delta(rho.size(), 3);
  for (std::size_t i = 0; i < rho.size(); ++i) {
    rho.set(i, {0.2, 0.5, 0.8});
    delta.set(i, Spectrum(0.5)), E.set(i, Spectrum(1, 2, 3) + delta[i]);
  }
  room.patches.rho = rho, room.patches.M = Field(rho.size(), 3);
  ElementMesh mesh(room.patches, room.map);
  FineRadiosity fine(mesh, room.patches, E, delta);
  for (const std::uint32_t leaf : mesh.leaves())
    if (mesh[leaf].is_leaf() && leaf % 5 == 0) mesh.cut(leaf, leaf % 3, 0.25);
  mesh.split(mesh.leaves());
  const std::size_t points = mesh.points().position.size();
  VertexField field;
  field.E = field.delta_light = Field(points, 3);
  field.known.assign(points, true);
  for (std::size_t p = 0; p < points; ++p) {
    field.delta_light.set(p, Spectrum(p % 2 ? 7 : 0));
    field.E.set(p, Spectrum(p % 3 == 0 ? 10 : 0, 1 + p % 5, 2) + field.delta_light[p]);
  }
  fine.take(field);
  std::vector<Spectrum> flux(rho.size());
  double most = 0;
  for (const std::uint32_t leaf : mesh.leaves()) {
    const auto x = mesh.corner_positions(leaf);
    const std::size_t i = mesh[leaf].patch;
    const Spectrum middle = fine.above_mean(PatchId{i}, within(x, 1. / 3, 1. / 3));
    flux[i] += middle * (mesh[leaf].area / room.patches.area[i]), most = std::max(most, middle[0]);
  }
  EXPECT_GT(most, 0.05);
  for (const Spectrum& above : flux)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(above[c], 0, 1e-5);
}

TEST(FineRadiosity, IsNeverNegative) {
  const MeshedRoom room(testing::room_with_box(), 0.6);
  Field E(room.patches.patch_count(), 1);  // dark and bright in turn: what is linear would be negative
  for (std::size_t i = 0; i < E.size(); ++i) E.set(i, Spectrum(i % 3 == 0 ? 30 : 0.1));
  const ElementMesh mesh(room.patches, room.map);
  const FineRadiosity fine(mesh, room.patches, E, Field(E.size(), 1));
  for (std::size_t i = 0; i < E.size(); ++i)
    for (const double a : {-0.3, 0., 0.5, 1., 1.3})  // beside it, too
      for (const double b : {-0.3, 0., 0.3})
        EXPECT_GE(reflected(fine, room.patches, E, i, within(room.patches.corner_positions(PatchId{i}), a, b)), 0);
}

/// Radiosity of patches that reflect E and emit nothing here.
Field reflected(const PatchSet& patches, const Field& E) {
  Field B(E.size(), 1);
  for (std::size_t i = 0; i < E.size(); ++i) B.set(i, patches.rho[i] * E[i]);
  return B;
}

TEST(FineRadiosity, TellsAGatherInACornerWhatIsNearIt) {
  // Light on the floor and the walls falls off towards the edges where they meet; elements of 60 cm against 6 cm.
  const MeshedRoom coarse(testing::room_with_box(), 0.6), fine(testing::room_with_box(), 0.06);
  const auto light_in = [](const PatchSet& patches) {
    return [&patches](const Vec3& x) {
      const Vec3 p = x + patches.origin;
      return 2 + 10 * std::min({p.x, 4 - p.x, 1.0}) + 10 * std::min(p.z, 1.0);
    };
  };
  const Field E = means(coarse.patches, light_in(coarse.patches));
  const Field B = reflected(coarse.patches, E),
              B_fine = reflected(fine.patches, means(fine.patches, light_in(fine.patches)));
  const ElementMesh mesh(coarse.patches, coarse.map);
  const FineRadiosity near(mesh, coarse.patches, E, Field(E.size(), 1));
  const Problem problem = coarse.problem(), problem_fine = fine.problem();
  const Illumination by_means(problem, B), exact(problem_fine, B_fine);
  Illumination by_places(problem, B);
  by_places.above_mean = [&](PatchId patch, const Vec3& x) { return near.above_mean(patch, x); };
  const GatherPattern pattern(test::gather_quality({16, 1024, 1024}, 0), 1);
  const auto gather = [&](const Illumination& light, double y) {
    unsigned long long rays = 0;
    const Vec3 n{1, 0, 0}, p = Vec3{0, y, 0.01} - light.problem.patches.origin + n * light.problem.rays.lift();
    return gather_point(light, p, n, pattern, GatherPlan{}, rays).E[0];
  };
  double off_by_means = 0, off_by_places = 0;
  for (const double y : {0.35, 0.85, 1.45, 2.05, 2.65}) {
    const double E_exact = gather(exact, y);
    off_by_means += std::abs(gather(by_means, y) - E_exact), off_by_places += std::abs(gather(by_places, y) - E_exact);
  }
  EXPECT_LT(off_by_places, 0.3 * off_by_means);
}

}  // namespace
}  // namespace clerestory
