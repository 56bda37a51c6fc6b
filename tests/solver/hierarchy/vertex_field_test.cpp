#include "solver/hierarchy/vertex_field.h"

#include <cmath>

#include <gtest/gtest.h>

#include "solver/gather/gather_point.h"
#include "solver/hierarchy/fine_radiosity.h"
#include "solver/hierarchy/gradients.h"
#include "solver/model/parallel.h"
#include "tests/solver/hierarchy/field_scenes.h"
#include "tests/support/gather_quality.h"

namespace clerestory {
namespace {

using testing::MeshedRoom;

constexpr GatherQuality kFew = test::gather_quality({16, 256, 256}, 256);

Field emission(const PatchSet& patches) { return patches.M; }

TEST(GatherField, HalvesWhereShadowsAreAndNotWhereLightIsEven) {
  const MeshedRoom room(testing::room_with_box(), 0.6);
  ElementMesh mesh(room.patches, room.map);
  const VertexField field = gather_field(room.problem(), emission(room.patches), mesh,
                                         {.tolerance = 0.05, .shortest_edge = 0.08, .quality = kFew});
  EXPECT_TRUE(field.complete);
  EXPECT_EQ(field.E.size(), mesh.points().position.size());
  double near_box = 0, far = 0, near_count = 0, far_count = 0;
  for (const std::uint32_t leaf : mesh.leaves()) {
    const auto x = mesh.corner_positions(leaf);
    const Vec3 c = (x[0] + x[1] + x[2]) / 3 + room.patches.origin;
    if (c.z > 1e-6) continue;  // the floor
    const double from_box = std::max({1 - c.x, c.x - 1.6, 1 - c.y, c.y - 1.7});
    const double longest = mesh.longest_edge(leaf);
    if (from_box > 0 && from_box < 0.2) near_box += longest, ++near_count;
    if (c.x > 3) far += longest, ++far_count;
  }
  ASSERT_GT(near_count, 0);
  ASSERT_GT(far_count, 0);
  EXPECT_LT(near_box / near_count, 0.5 * far / far_count);
}

TEST(GatherField, ATighterToleranceInterpolatesBetter) {
  // Against the same gather at the middle of each leaf: only interpolation differs.
  const MeshedRoom room(testing::room_with_box(), 0.6);
  // Walls that shine as in a lit room, brighter at the top: shadows at the box, no edge that is sharp.
  Field B(room.patches.patch_count(), 1);
  for (std::size_t p = 0; p < B.size(); ++p) B.set(p, Spectrum(3 + room.patches.corner_positions(PatchId{p})[0].z));
  double before = 1;
  for (const double tolerance : {0.2, 0.05, 0.02}) {
    ElementMesh mesh(room.patches, room.map);
    const VertexField field =
        gather_field(room.problem(), B, mesh, {.tolerance = tolerance, .shortest_edge = 0.04, .quality = kFew});
    const Problem problem = room.problem();
    const Illumination light(problem, B);
    const GatherPattern pattern(kFew, 1);
    double squares = 0, mean = 0, area = 0;
    for (const std::uint32_t leaf : mesh.leaves()) {
      const auto point = mesh.points_of(leaf);
      const auto x = mesh.corner_positions(leaf);
      const Vec3 n = room.patches.normal[mesh[leaf].patch];
      unsigned long long rays = 0;
      const double E =
          gather_point(light, (x[0] + x[1] + x[2]) / 3 + n * room.rays.lift(), n, pattern, GatherPlan{}, rays).E[0];
      const double linear = (field.E[point[0]][0] + field.E[point[1]][0] + field.E[point[2]][0]) / 3;
      const double a = mesh[leaf].area;
      squares += a * (linear - E) * (linear - E), mean += a * E, area += a;
    }
    const double error = std::sqrt(squares / area) / (mean / area);
    EXPECT_LT(error, before) << tolerance;
    EXPECT_LT(error, tolerance) << "which each leaf is held to, but for edges that are short enough";
    before = error;
  }
}

TEST(GatherField, HalvesABrightStripOnForTheRoomThatItIsIn) {
  // A sill 4 cm wide before a window of its length, under a lintel: there it is a hundred times as bright as the room,
  // and half as bright at its ends. Against the same gather at the middle of each of its leaves.
  testing::SceneMaker maker;
  const MaterialId black = maker.material("black", 0);
  maker.edit(black).sides = 1;
  const MaterialId lamp = maker.material("lamp", 0);
  maker.edit(lamp).sides = 1, maker.edit(lamp).exitance = Spectrum(1000);
  maker.polygon({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}}, black);
  maker.polygon({{0, 0, 2.5}, {0, 3, 2.5}, {4, 3, 2.5}, {4, 0, 2.5}}, black);
  maker.polygon({{1, 3, 1}, {2, 3, 1}, {2, 3.04, 1}, {1, 3.04, 1}}, black);
  maker.polygon({{1, 3.04, 1}, {2, 3.04, 1}, {2, 3.04, 1.5}, {1, 3.04, 1.5}}, lamp);
  const MeshedRoom room(std::move(maker), 0.6);
  const auto error_of_sill = [&](const FieldOptions& options) {
    ElementMesh mesh(room.patches, room.map);
    const Field B = emission(room.patches);
    const VertexField field = gather_field(room.problem(), B, mesh, options);
    const Problem problem = room.problem();
    const Illumination light(problem, B);
    const GatherPattern pattern(options.quality, 1);
    double squares = 0, flux = 0, area = 0, of_room = 0;
    for (const std::uint32_t leaf : mesh.leaves()) {
      const auto point = mesh.points_of(leaf);
      const auto x = mesh.corner_positions(leaf);
      const Vec3 n = room.patches.normal[mesh[leaf].patch], c = (x[0] + x[1] + x[2]) / 3;
      const double linear = (field.E[point[0]][0] + field.E[point[1]][0] + field.E[point[2]][0]) / 3,
                   a = mesh[leaf].area;
      flux += a * linear, of_room += a;
      if (n.z < 0.5 || std::abs(c.z + room.patches.origin.z - 1) > 1e-6) continue;
      unsigned long long rays = 0;
      const double E = gather_point(light, c + n * room.rays.lift(), n, pattern, rays).E[0];
      squares += a * (linear - E) * (linear - E), area += a;
    }
    EXPECT_NEAR(area, 0.04, 1e-9);
    return std::sqrt(squares / of_room) / (flux / of_room);
  };
  EXPECT_LT(error_of_sill({.tolerance = 0.05, .shortest_edge = 0.2, .quality = kFew}), 0.03);
}

TEST(GatherField, PointsOfOnePlaceTakeEachOthersLightButForLuminaires) {
  // Elements of 8 cm where none is halved below 60 cm: what is within 15 cm on a face counts as one place.
  testing::SceneMaker maker = testing::room_with_box();
  maker.scene().lights.luminaires.push_back({"", {0.8, 0.8, 2}, "", PointLuminaire{Spectrum(3)}});
  const MeshedRoom room(maker, 0.08);
  const std::size_t points = room.map.position.size();
  const auto field = [&](double shortest_edge) {
    ElementMesh mesh(room.patches, room.map);
    return gather_field(room.problem(), emission(room.patches), mesh,
                        {.tolerance = 0.1, .shortest_edge = shortest_edge, .most_points = points, .quality = kFew});
  };
  const VertexField each = field(1e-6), shared = field(0.6);
  EXPECT_EQ(each.alike, 0u);
  EXPECT_GT(shared.alike, points / 2);
  EXPECT_LT(shared.rays, each.rays / 2);
  double squares = 0, mean = 0;
  for (std::size_t p = 0; p < points; ++p) {
    ASSERT_EQ(shared.delta_light[p][0], each.delta_light[p][0]) << "its own";
    ASSERT_GE(shared.E[p][0], shared.delta_light[p][0]);
    squares += (shared.E[p][0] - each.E[p][0]) * (shared.E[p][0] - each.E[p][0]);
    mean += each.E[p][0] - each.delta_light[p][0];
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(points)), 0.1 * mean / static_cast<double>(points));
}

TEST(GatherField, IsTheSameForOneAndTwoThreads) {
  const MeshedRoom room(testing::room_with_box(), 0.6);
  std::vector<double> E[2];
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    ElementMesh mesh(room.patches, room.map);
    Field lit(room.patches.patch_count(), 1);
    for (std::size_t i = 0; i < lit.size(); ++i) lit.set(i, Spectrum(5.0 + static_cast<double>(i % 3)));
    const Field none(lit.size(), 1);
    FineRadiosity fine(mesh, room.patches, lit, none);
    E[threads - 1] = gather_field(room.problem(), emission(room.patches), mesh,
                                  {.tolerance = 0.1, .shortest_edge = 0.1, .quality = kFew}, {}, nullptr, {}, &fine)
                         .E.value;
  }
  set_thread_count(0);
  EXPECT_EQ(E[0], E[1]);
}

TEST(GatherField, KeepsToItsNumberOfPoints) {
  const MeshedRoom room(testing::room_with_box(), 0.6);
  const std::size_t own = room.map.position.size();
  // What conformity asks for comes on top of the leaves that are chosen: at most the points that halving one of them
  // alone makes, and of several no more than their sum, as halvings that two of them ask for are done once.
  std::size_t most_of_one = 0;
  for (const std::uint32_t leaf : ElementMesh(room.patches, room.map).leaves()) {
    ElementMesh mesh(room.patches, room.map);
    mesh.split(std::vector{leaf});
    most_of_one = std::max(most_of_one, mesh.points().position.size() - own);
  }
  const auto points_made = [&](std::size_t budget) {
    ElementMesh mesh(room.patches, room.map);
    gather_field(room.problem(), emission(room.patches), mesh,
                 {.tolerance = 0.001, .shortest_edge = 1e-3, .most_points = own + budget, .quality = kFew});
    return mesh.points().position.size() - own;
  };
  EXPECT_EQ(points_made(0), 0u);
  for (const std::size_t budget : {1u, 10u, 200u}) {
    EXPECT_GE(points_made(budget), budget) << "at this tolerance there is always more to halve";
    EXPECT_LE(points_made(budget), budget * most_of_one);
  }
}

TEST(LeafIrradiance, IsExactForQuadraticLight) {
  const MeshedRoom room(testing::room_with_box(), 0.3);
  const ElementMesh mesh(room.patches, room.map);
  const auto light = [](const Vec3& x) { return 10 - x.x * x.x - 0.5 * x.y * x.y + 0.3 * x.x * x.y; };
  Field E(room.map.position.size(), 1);
  for (std::size_t p = 0; p < E.size(); ++p) E.set(p, Spectrum(light(room.map.position[p])));
  const Field mean = leaf_irradiance(mesh, E);
  // Over the ceiling as a whole; at its rim the gradient leans to one side.
  double curved = 0, linear = 0, exact = 0;
  for (std::size_t p = 0; p < room.patches.patch_count(); ++p) {
    if (room.patches.normal[p].z > -0.9) continue;
    const auto x = room.patches.corner_positions(PatchId{p});
    const double A = room.patches.area[p];
    curved += A * mean[p][0];
    for (std::size_t k = 0; k < 3; ++k) {
      linear += A * light(x[k]) / 3;
      exact += A * light((x[k] + x[(k + 1) % 3]) / 2) / 3;
    }
  }
  EXPECT_LT(std::abs(curved - exact), 0.3 * std::abs(linear - exact));
}

}  // namespace
}  // namespace clerestory
