#include "meshing/atlas/make_atlas.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "meshing/atlas/pack_charts.h"
#include "solver/model/bake_points.h"
#include "solver/model/error.h"
#include "solver/model/parallel.h"
#include "tests/meshing/atlas/lit_surfaces.h"

namespace clerestory {
namespace {

/// Calls visit(triangle, weights of its corners, looked up, linear) at many points of all triangles.
template <class Visit>
void for_lookups(const WrittenResult& result, const LightmapAtlas& atlas, const Visit& visit) {
  const std::vector<float>& lux = result.of_points.at("illuminance").value;
  constexpr int n = 12;
  for (std::size_t t = 0; t < result.triangles.size(); ++t)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) {
        const std::array<double, 3> w{double{1} * i / n, double{1} * j / n, 1 - double{1} * (i + j) / n};
        double u = 0, v = 0, linear = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          u += w[k] * atlas.uv[t][k][0], v += w[k] * atlas.uv[t][k][1];
          linear += w[k] * lux[result.triangles[t][k]];
        }
        visit(t, w, double{atlas.lookup(static_cast<float>(u), static_cast<float>(v), 0)}, linear);
      }
}

double worst_of(const WrittenResult& result, const LightmapAtlas& atlas) {
  double worst = 0;
  for_lookups(result, atlas, [&](std::size_t, const auto&, double looked_up, double linear) {
    worst = std::max(worst, std::abs(looked_up - linear) / linear);
  });
  return worst;
}

TEST(MakeAtlas, ALinearFieldIsLookedUpAsItIs) {
  LitSurfaces room;
  const auto lux = [](const Vec3& p) { return 500 + 40 * p.x - 30 * p.y + 25 * p.z; };
  room.add_surface("tilted");
  room.add_grid(rectangle({0, 0, 0}, {3, 1, 0.5}, {-0.7, 2, 0.2}), 5, 4, lux);
  room.add_surface("triangle");  // slanted edges: texels beyond them go on as the field does
  room.add_triangle(room.add_point({0, 0, 4}, lux({0, 0, 4})), room.add_point({2, 0.3, 4}, lux({2, 0.3, 4})),
                    room.add_point({0.4, 1.7, 4}, lux({0.4, 1.7, 4})));
  const LightmapAtlas atlas = make_atlas(room.result, 15);
  EXPECT_LT(worst_of(room.result, atlas), 2e-5);  // float, and gradients of a texel times uv's rounding
  EXPECT_LT(atlas.error.worst, 2e-5);
  EXPECT_EQ(atlas.error.share_within_1_percent, 1);
}

TEST(MakeAtlas, ABentFieldIsWithinAPercentWhereElementsAreLargerThanTexels) {
  LitSurfaces floor;
  floor.add_surface("floor");
  floor.add_grid(rectangle({0, 0, 0}, {5, 0, 0}, {0, 4, 0}), 20, 16,
                 [](const Vec3& p) { return 300 + 150 * std::sin(1.3 * p.x) * std::cos(p.y); });
  const LightmapAtlas atlas = make_atlas(floor.result, 20);
  EXPECT_LT(worst_of(floor.result, atlas), 0.01);
  EXPECT_GE(atlas.used, 0.95);
}

TEST(MakeAtlas, TexelsThatHardlyAnySampleReachesGoOnAsTheFieldDoes) {
  // Rims in all directions: a disc. Its outermost texels have a say in a hundredth of a texel only.
  LitSurfaces disc;
  disc.add_surface("disc");
  disc.add_grid(
      [](double s, double t) {
        const double a = 2 * std::numbers::pi * s, r = 0.2 + 1.8 * t;
        return Vec3{r * std::cos(a), -r * std::sin(a), 0};
      },
      48, 10, [](const Vec3& p) { return 100 + 80 * std::sin(3 * p.x); });
  const LightmapAtlas atlas = make_atlas(disc.result, 20);
  for (std::size_t i = 0; i < atlas.texels(); ++i) {
    EXPECT_GT(atlas.at(i, 0), 0.5 * 20);
    EXPECT_LT(atlas.at(i, 0), 1.5 * 180);
  }
}

TEST(MakeAtlas, NothingLeaksFromABrightNeighbourIntoTheDark) {
  LitSurfaces floor;
  for (int i = 0; i < 8; ++i)  // strips of one plane side by side, with points of their own
    for (int j = 0; j < 2; ++j) {
      floor.add_surface("strip");
      floor.add_grid(rectangle({0.31 * i, 1.7 * j, 0}, {0.31, 0, 0}, {0, 1.7, 0}), 2, 3,
                     [&](const Vec3&) { return (i + j) % 2 ? 1e4 : 0; });
    }
  const LightmapAtlas atlas = make_atlas(floor.result, 20);
  for_lookups(floor.result, atlas, [](std::size_t, const auto&, double looked_up, double linear) {
    EXPECT_NEAR(looked_up, linear, linear * 1e-6);  // 0 is 0
  });
}

TEST(MakeAtlas, TwoSidesOfAThinWallOnOneFloorDoNotMix) {
  // A wall of 4 cm, less than a texel, that ends in the room: light on one side of it and none on the other.
  LitSurfaces floor;
  floor.add_surface("floor");
  constexpr int n = 100;
  const auto is_wall = [](int i, int j) { return i == 50 && j < 60; };
  floor.add_grid(
      rectangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0}), n, n / 2,
      [](const Vec3& p) { return p.x > 2.03 && p.y < 2.3 ? 1000.0
                                 : p.y < 2.3             ? 1
                                                         : 100; },
      [&](int i, int j) { return !is_wall(i, 2 * j); });
  const LightmapAtlas atlas = make_atlas(floor.result, 20);
  for_lookups(floor.result, atlas, [&](std::size_t t, const auto&, double looked_up, double linear) {
    double y = 0;
    for (const std::uint32_t p : floor.result.triangles[t]) y = std::max(y, floor.result.points[p].y);
    if (y < 2) {
      EXPECT_NEAR(looked_up, linear, 0.01 * linear);
    }
  });
}

TEST(MakeAtlas, AColumnOfFacetsIsWithinAPercentAndHasNoSeam) {
  LitSurfaces column;
  column.add_surface("column");
  const auto place = [](double s, double t) {
    const double a = 2 * std::numbers::pi * s;
    return Vec3{std::cos(a), std::sin(a), 3 * t};
  };
  column.add_grid(place, 72, 12, [](const Vec3& p) { return 200 + 60 * p.x + 30 * p.z; });
  const LightmapAtlas atlas = make_atlas(column.result, 20);
  EXPECT_LT(worst_of(column.result, atlas), 0.01);
}

TEST(MakeAtlas, JunctionsInTheMiddleOfAnEdgeKeepEachSidesOwnField) {
  // One long edge against two short ones, whose middle point does not lie on the long one's line of values.
  LitSurfaces wall;
  wall.add_surface("wall");
  const auto a = wall.add_point({0, 0, 0}, 100), b = wall.add_point({2, 0, 0}, 140), m = wall.add_point({1, 0, 0}, 150);
  const auto top = wall.add_point({1, 1.5, 0}, 90), left = wall.add_point({0, -1, 0}, 80),
             right = wall.add_point({2, -1, 0}, 160);
  wall.add_triangle(a, b, top);
  wall.add_triangle(a, left, m);
  wall.add_triangle(m, left, right);
  wall.add_triangle(m, right, b);
  const LightmapAtlas atlas = make_atlas(wall.result, 30);
  EXPECT_LT(worst_of(wall.result, atlas), 0.01);
}

TEST(MakeAtlas, UsesThreeQuartersOfThePictureForARoomWithFurniture) {
  LitSurfaces room;
  const auto lux = [](const Vec3& p) { return 100 + 10 * p.x; };
  room.add_surface("floor");
  room.add_grid(rectangle({0, 0, 0}, {7, 0, 0}, {0, 5, 0}), 14, 10, lux, [](int i, int j) { return i < 9 || j < 6; });
  room.add_surface("walls");
  room.add_grid(rectangle({0, 0, 0}, {0, 0, 3}, {7, 0, 0}), 6, 14, lux);
  room.add_grid(rectangle({0, 0, 0}, {0, 5, 0}, {0, 0, 3}), 10, 6, lux);
  for (int desk = 0; desk < 12; ++desk) {
    room.add_surface("desk");
    const Vec3 at{1.0 * (desk % 4), 1.3 * (desk / 4), 0.7};
    room.add_grid(rectangle(at, {0.7, 0, 0}, {0, 0.5, 0}), 3, 2, lux);
    for (int leg = 0; leg < 4; ++leg)
      room.add_grid(rectangle(at + Vec3{0.65 * (leg % 2), 0.45 * (leg / 2), -0.7}, {0.04, 0, 0}, {0, 0, 0.7}), 1, 2,
                    lux);
  }
  room.add_surface("gable");
  room.add_triangle(room.add_point({0, 0, 3}, 5), room.add_point({7, 0, 3}, 5), room.add_point({3.5, 0, 5}, 5));
  EXPECT_GE(make_atlas(room.result, 20).used, 0.75);
}

TEST(MakeAtlas, HasAPlaceInThePictureForTrianglesWithoutArea) {
  LitSurfaces odd;
  odd.add_surface("odd");
  odd.add_grid(rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 2, 2, [](const Vec3&) { return 7; });
  odd.add_triangle(0, 1, 0);
  const auto p = odd.add_point({5, 5, 5}, 3);
  odd.add_triangle(p, p, p);
  odd.add_triangle(odd.add_point({0, 0, 2}, 1), odd.add_point({1, 0, 2}, 2), odd.add_point({1, 1e-6, 2}, 3));
  const LightmapAtlas atlas = make_atlas(odd.result, 20);
  EXPECT_LT(worst_of(odd.result, atlas), 0.01);
  for (const float x : atlas.value) EXPECT_TRUE(std::isfinite(x));
}

TEST(MakeAtlas, OfNothingIsAPictureOfNothing) {
  const LightmapAtlas atlas = make_atlas(LitSurfaces().result, 20);
  EXPECT_TRUE(atlas.charts.empty());
  EXPECT_EQ(atlas.value.size(), atlas.texels() * 2);
}

TEST(MakeAtlas, RefusesWhatIsLargerThanAnyPictureAndSaysWhatFits) {
  LitSurfaces field;
  field.add_surface("field");
  field.add_grid(rectangle({0, 0, 0}, {100'000, 0, 0}, {0, 100'000, 0}), 100, 100, [](const Vec3&) { return 1; });
  double fits = 0;
  try {
    make_atlas(field.result, 5);
    FAIL();
  } catch (const InputError& e) {
    const std::string message = e.what();
    const std::size_t place = message.find("--texels-per-metre ");
    ASSERT_NE(place, message.npos) << message;
    fits = std::stod(message.substr(place + 19));
  }
  EXPECT_GT(fits, 0.05);  // 16384 texels on 100 km are 0.16
  EXPECT_LT(fits, 0.16384);
}

TEST(MakeAtlas, IsTheSameForAnyNumberOfThreads) {
  LitSurfaces column;
  column.add_surface("column");
  column.add_grid(
      [](double s, double t) {
        return Vec3{std::cos(6 * s), std::sin(6 * s), 3 * t};
      },
      60, 9, [](const Vec3& p) { return std::exp(2 * p.x + p.z); });
  set_thread_count(1);
  const LightmapAtlas one = make_atlas(column.result, 20);
  set_thread_count(4);
  const LightmapAtlas four = make_atlas(column.result, 20);
  set_thread_count(0);
  EXPECT_EQ(one.value, four.value);
  EXPECT_EQ(one.uv, four.uv);
  EXPECT_EQ(one.error.worst, four.error.worst);
  EXPECT_EQ(one.error.p95, four.error.p95);
}

TEST(WithAtlas, SplitsVerticesBetweenChartsAndKeepsTheirLight) {
  LitSurfaces column;
  column.add_surface("column");
  column.add_grid(
      [](double s, double t) {
        return Vec3{std::cos(6 * s), std::sin(6 * s), 3 * t};
      },
      60, 9, [](const Vec3& p) { return 100 + p.z; });
  const LightmapAtlas atlas = make_atlas(column.result, 20);
  const BakedMesh whole = baked_points(column.result), split = with_atlas(whole, atlas);
  EXPECT_GT(split.position.size(), whole.position.size());
  ASSERT_EQ(split.atlas_uv.size(), split.position.size());
  ASSERT_EQ(split.triangles.size(), whole.triangles.size());
  for (std::size_t t = 0; t < whole.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = whole.triangles[t][k], b = split.triangles[t][k];
      EXPECT_EQ(whole.position[a], split.position[b]);
      EXPECT_EQ(whole.illuminance[a], split.illuminance[b]);
      EXPECT_EQ(split.atlas_uv[b], atlas.uv[t][k]);
      for (const float x : split.atlas_uv[b]) EXPECT_TRUE(x >= 0 && x <= 1);
    }
}

}  // namespace
}  // namespace clerestory
