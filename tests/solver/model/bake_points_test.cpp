#include "solver/model/bake_points.h"

#include <gtest/gtest.h>

#include "tests/support/flat_result.h"

namespace clerestory {
namespace {

constexpr auto kDay = [](const Vec3&) { return 10.0; };

TEST(BakedPoints, HasTheResultsPointsInTheirOrderWithTheirLight) {
  WrittenResult r = empty_result(3);
  add_rectangle(r, {1, 2, 3}, {2, 0, 0}, {0, 2, 0}, 3, [](const Vec3& p) { return p.x; });
  const BakedMesh mesh = baked_points(r);
  ASSERT_EQ(mesh.position.size(), 16u);
  EXPECT_EQ(mesh.position, r.points);
  EXPECT_EQ(mesh.triangles, r.triangles);
  EXPECT_EQ(mesh.illuminance, r.of_points["illuminance"].value);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(mesh.normal[i], (Vec3{0, 0, 1}));
    for (int k = 0; k < 3; ++k)
      EXPECT_FLOAT_EQ(static_cast<float>(mesh.E.at(i, k)), static_cast<float>(r.points[i].x * (1 + 0.25 * k)));
    EXPECT_EQ(mesh.shown[i], mesh.E[i]);  // irradiance, as the paint does not glow
  }
}

TEST(BakedPoints, NormalsOfASharedPointAreTheMeanOfTheFacetsByArea) {
  WrittenResult r = empty_result();
  add_rectangle(r, {0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 1, kDay);
  // A wall of the same width and half the height goes up from the far edge of the floor, facing it.
  r.points.push_back({0, 1, 0.5}), r.points.push_back({2, 1, 0.5});
  for (auto& [name, array] : r.of_points) array.value.insert(array.value.end(), 2, 1.0F);
  r.triangles.push_back({2, 3, 5}), r.triangles.push_back({2, 5, 4});
  r.surface.resize(4), r.material.resize(4);
  // Point 3: floor triangle (0, 1, 3) and (0, 3, 2) of 1 m2 each; of the wall (2, 3, 5) of 0.5 m2: (0, -0.5, 2).
  EXPECT_NEAR(length(baked_points(r).normal[3] - normalized(Vec3{0, -0.5, 2})), 0, 1e-12);
}

TEST(BakedPoints, SurfacesThatGlowShowWhatTheySendAndBlackSidesNothing) {
  WrittenResult r = empty_result();
  r.materials.resize(3);
  r.materials[1].name = "panel";
  add_rectangle(r, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, kDay, 0, 0);
  add_rectangle(r, {2, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, kDay, 0, 1);
  add_rectangle(r, {4, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, kDay, 0, 2);
  auto& B = r.of_points["radiosity"].value;
  for (std::size_t i = 4; i < 8; ++i) B[i] += 100;  // 100 of its own, and 5 of 10 reflected
  for (std::size_t i = 8; i < 12; ++i) B[i] = 0;    // the back of a one-sided material
  EXPECT_EQ(glowing_materials(r), (std::vector<bool>{false, true, false}));
  const BakedMesh mesh = baked_points(r);
  EXPECT_EQ(mesh.shown[0], Spectrum(10));
  EXPECT_EQ(mesh.shown[5], Spectrum(105));
  EXPECT_EQ(mesh.shown[9], Spectrum(0.0));
  EXPECT_EQ(mesh.E[5], Spectrum(10));
}

TEST(NearOrigin, IsTheOriginUntilFloatsLoseAQuarterOfAMillimetre) {
  EXPECT_EQ(near_origin({}), Vec3{});
  EXPECT_EQ(near_origin({{-4000, 0, 0}, {4000, 1, 2}}), Vec3{});
  EXPECT_EQ(near_origin({{1e6, -2e6, 50}, {1e6 + 3, -2e6 + 4, 50}}), (Vec3{1000002, -1999998, 50}));
}

}  // namespace
}  // namespace clerestory
