#include "pipeline/bake/light_on_model.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "solver/model/parallel.h"
#include "tests/support/flat_result.h"

namespace clerestory {
namespace {

/// A rectangle as two triangles on four vertices.
ModelPart rectangle(const Vec3& corner, const Vec3& u, const Vec3& v) {
  ModelPart part;
  part.position = {corner, corner + u, corner + u + v, corner + v};
  part.triangles = {{0, 1, 2}, {0, 2, 3}};
  return part;
}

double linear(const Vec3& p) { return 1 + p.x + 2 * p.y; }

TEST(LightOnModel, IsTheFieldAtEachVertex) {
  WrittenResult r = empty_result(3);
  add_rectangle(r, {}, {4, 0, 0}, {0, 3, 0}, 7, linear);
  const ModelPart floor = rectangle({}, {4, 0, 0}, {0, 3, 0});
  ModelPart fine;  // finer than the result, and its vertices on none of its points
  for (int y = 0; y <= 11; ++y)
    for (int x = 0; x <= 11; ++x) fine.position.push_back({4.0 * x / 11, 3.0 * y / 11, 0});
  for (std::uint32_t y = 0; y < 11; ++y)
    for (std::uint32_t x = 0; x < 11; ++x) {
      const std::uint32_t a = 12 * y + x;
      fine.triangles.push_back({a, a + 1, a + 13}), fine.triangles.push_back({a, a + 13, a + 12});
    }
  const std::vector<ModelPart> parts = {floor, fine};
  const LitModel lit = light_on_model(r, parts);
  EXPECT_EQ(lit.missing_share, 0);
  for (std::size_t p = 0; p < 2; ++p) {
    const LitPart& part = lit.parts[p];
    ASSERT_EQ(part.vertex.size(), parts[p].position.size()) << "vertices stay as they are";
    EXPECT_EQ(part.triangles, parts[p].triangles);
    EXPECT_EQ(part.material, 0u);
    for (std::size_t i = 0; i < part.vertex.size(); ++i) {
      EXPECT_EQ(part.vertex[i], i);
      const double exact = linear(parts[p].position[i]);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(part.E.at(i, k) / (exact * (1 + 0.25 * k)), 1, 1e-5) << i;
      EXPECT_NEAR(part.illuminance[i] / (179 * exact), 1, 1e-5);
      EXPECT_LT(length(part.normal[i] - Vec3{0, 0, 1}), 1e-12);
    }
  }
}

TEST(LightOnModel, DoesNotLeakPastAPartition) {
  // A floor with a partition at x = 2 on it: bright before, dim behind. The model's vertices are shared over the line.
  WrittenResult r = empty_result();
  add_rectangle(r, {}, {2, 0, 0}, {0, 3, 0}, 6, [](const Vec3&) { return 100.0; });
  add_rectangle(r, {2, 0, 0}, {2, 0, 0}, {0, 3, 0}, 6, [](const Vec3&) { return 1.0; });
  ModelPart floor;
  floor.position = {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {4, 3, 0}, {2, 3, 0}, {0, 3, 0}};
  floor.triangles = {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}};
  const LitPart lit = light_on_model(r, std::vector{floor}).parts[0];
  ASSERT_EQ(lit.vertex.size(), 8u) << "the two on the line are split";
  for (std::size_t t = 0; t < 4; ++t)
    for (const std::uint32_t v : lit.triangles[t]) EXPECT_FLOAT_EQ(static_cast<float>(lit.E.at(v, 0)), t < 2 ? 100 : 1);
}

TEST(LightOnModel, BothSidesOfASheetAreTrianglesOfTheirOwn) {
  WrittenResult r = empty_result();
  add_rectangle(r, {}, {1, 0, 0}, {0, 1, 0}, 2, [](const Vec3&) { return 8.0; });
  add_rectangle(r, {0, 1, 0}, {1, 0, 0}, {0, -1, 0}, 2, [](const Vec3&) { return 3.0; });  // from below
  const LitPart lit = light_on_model(r, std::vector{rectangle({}, {1, 0, 0}, {0, 1, 0})}).parts[0];
  ASSERT_EQ(lit.triangles.size(), 4u);
  ASSERT_EQ(lit.vertex.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_FLOAT_EQ(static_cast<float>(lit.E.at(i, 0)), lit.is_back[i] ? 3 : 8);
    EXPECT_EQ(lit.normal[i], (Vec3{0, 0, lit.is_back[i] ? -1.0 : 1.0}));
  }
  EXPECT_EQ(lit.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_TRUE(lit.is_back[lit.triangles[1][0]]);
  EXPECT_EQ(lit.vertex[lit.triangles[1][0]], 2u) << "turned round";
}

TEST(LightOnModel, AFaceThatIsLitFromBehindShowsItsBackAndOneWithoutLightABlackFront) {
  WrittenResult r = empty_result();
  add_rectangle(r, {0, 1, 0}, {1, 0, 0}, {0, -1, 0}, 2, [](const Vec3&) { return 3.0; });
  const std::vector<ModelPart> parts = {rectangle({}, {1, 0, 0}, {0, 1, 0}), rectangle({5, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                                        rectangle({1, 0, 0}, {1, 0, 0}, {0, 1, 0})};
  const LitModel lit = light_on_model(r, parts);
  for (const bool back : lit.parts[0].is_back) EXPECT_TRUE(back);
  for (const std::size_t dark : {std::size_t{1}, std::size_t{2}}) {  // the last one beside the lit one, in its plane
    EXPECT_EQ(lit.parts[dark].triangles, parts[dark].triangles);
    EXPECT_FALSE(lit.parts[dark].material);
    for (const double E : lit.parts[dark].E.value) EXPECT_EQ(E, 0);
  }
}

TEST(LightOnModel, SharpEdgesAreSplitAndBentSurfacesAreNot) {
  WrittenResult r = empty_result();
  const auto even = [](const Vec3&) { return 5.0; };
  add_rectangle(r, {}, {1, 0, 0}, {0, 1, 0}, 2, even);
  add_rectangle(r, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 2, even);
  add_rectangle(r, {1, 0, 0}, {1, 0, 0.2}, {0, 1, 0}, 2, [](const Vec3&) { return 6.0; });
  ModelPart part;  // a floor, a wall over its edge at right angles, a ramp of 11 degrees over another
  part.position = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {2, 0, 0.2}, {2, 1, 0.2}};
  part.triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 5}, {3, 5, 4}, {1, 6, 7}, {1, 7, 2}};
  const LitPart lit = light_on_model(r, std::vector{part}).parts[0];
  EXPECT_EQ(lit.vertex.size(), 10u) << "the two between floor and wall, once more";
  const double at_ramp = lit.E.at(1, 0);
  EXPECT_TRUE(at_ramp > 5 && at_ramp < 6) << at_ramp;
}

TEST(LightOnModel, SliversThatTheMesherDropsTakeTheLightBesideThem) {
  WrittenResult r = empty_result();
  add_rectangle(r, {}, {1, 0, 0}, {0, 1, 0}, 2, [](const Vec3&) { return 5.0; });
  ModelPart part = rectangle({}, {1, 0, 0}, {0, 1, 0});
  part.position.push_back({1, 1, -1e-6});                                  // of a bevel, and of a triangle without area
  part.position.push_back({0, 0, 0}), part.position.push_back({1, 1, 0});  // another on vertices of its own
  part.triangles.insert(part.triangles.begin(), {{2, 1, 4}, {0, 2, 2}, {5, 6, 5}});
  const LitPart lit = light_on_model(r, std::vector{part}).parts[0];
  ASSERT_EQ(lit.vertex.size(), 7u);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_FLOAT_EQ(static_cast<float>(lit.E.at(i, 0)), i == 4 ? 0 : 5) << i;
  EXPECT_EQ(lit.triangles.size(), 5u);
}

TEST(LightOnModel, GlassIsLeftOut) {
  WrittenResult r = empty_result();
  add_rectangle(r, {}, {1, 0, 0}, {0, 1, 0}, 2, linear);
  r.around.panes = {{{Vec3{0, 1, 0}, Vec3{1, 1, 0}, Vec3{1, 1, 2}}, 0, 0},
                    {{Vec3{0, 1, 0}, Vec3{1, 1, 2}, Vec3{0, 1, 2}}, 0, 0}};
  const std::vector<ModelPart> parts = {rectangle({}, {1, 0, 0}, {0, 1, 0}), rectangle({0, 1, 0}, {1, 0, 0}, {0, 0, 2}),
                                        rectangle({0, 1, 0}, {0, 0, 2}, {1, 0, 0})};
  const LitModel lit = light_on_model(r, parts);
  EXPECT_EQ(lit.parts[0].triangles.size(), 2u);
  EXPECT_TRUE(lit.parts[1].triangles.empty());
  EXPECT_TRUE(lit.parts[2].triangles.empty()) << "whichever way it faces";
}

TEST(LightOnModel, WhatWasSimplifiedIsFoundBesideWhereItIsButNotInPlaceOfAPane) {
  // A pane 5 mm under a lit sheet, and a face 3 mm off the result's, where it was moved by up to 10 mm.
  WrittenResult r = empty_result();
  r.figures["repairs.simplified_by"] = 0.01;
  add_rectangle(r, {}, {1, 0, 0}, {0, 1, 0}, 2, linear);
  add_rectangle(r, {5, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, linear);
  r.around.panes = {{{Vec3{0, 0, -0.005}, Vec3{1, 0, -0.005}, Vec3{1, 1, -0.005}}, 0, 0},
                    {{Vec3{0, 0, -0.005}, Vec3{1, 1, -0.005}, Vec3{0, 1, -0.005}}, 0, 0}};
  const std::vector<ModelPart> parts = {rectangle({}, {1, 0, 0}, {0, 1, 0}),
                                        rectangle({0, 0, -0.005}, {1, 0, 0}, {0, 1, 0}),
                                        rectangle({5, 0, 0.003}, {1, 0, 0}, {0, 1, 0})};
  const LitModel lit = light_on_model(r, parts);
  EXPECT_TRUE(lit.parts[1].triangles.empty());
  EXPECT_EQ(lit.missing_share, 0);
  for (const std::size_t p : {std::size_t{0}, std::size_t{2}})
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(lit.parts[p].E.at(i, 0) / linear(parts[p].position[i]), 1, 1e-5) << p << " " << i;
}

TEST(LightOnModel, TellsHowMuchOfTheResultIsOnNoFace) {
  WrittenResult r = empty_result();
  add_rectangle(r, {}, {1, 0, 0}, {0, 3, 0}, 4, linear);
  add_rectangle(r, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 4, linear);
  const std::vector<ModelPart> parts = {rectangle({}, {1, 0, 0}, {0, 3, 0}),
                                        rectangle({0, 0, 1.01}, {1, 0, 0}, {0, 1, 0})};
  EXPECT_NEAR(light_on_model(r, parts).missing_share, 0.25, 1e-12);
}

TEST(LightOnModel, IsTheSameForAnyNumberOfThreads) {
  WrittenResult r = empty_result();
  add_rectangle(r, {}, {4, 0, 0}, {0, 3, 0}, 50, [](const Vec3& p) { return 1 + p.x * p.y; });
  ModelPart fine = rectangle({}, {4, 0, 0}, {0, 3, 0});
  const std::vector<ModelPart> parts(700, fine);  // all in one place
  set_thread_count(1);
  const LitModel one = light_on_model(r, parts);
  set_thread_count(2);
  const LitModel two = light_on_model(r, parts);
  set_thread_count(0);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    EXPECT_EQ(one.parts[p].E.value, two.parts[p].E.value);
    EXPECT_EQ(one.parts[p].triangles, two.parts[p].triangles);
  }
}

}  // namespace
}  // namespace clerestory
