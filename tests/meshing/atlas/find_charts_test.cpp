#include "meshing/atlas/find_charts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "meshing/atlas/smallest_rectangle.h"
#include "tests/meshing/atlas/lit_surfaces.h"

namespace clerestory {
namespace {

double one(const Vec3&) { return 1; }

/// Each triangle is in one chart, of its surface, and none is turned over in it.
void expect_sound(const WrittenResult& result, const std::vector<AtlasChart>& charts, double texels_per_metre) {
  std::vector<int> times(result.triangles.size(), 0);
  for (const AtlasChart& chart : charts) {
    EXPECT_GE(chart.width, 2);
    EXPECT_GE(chart.height, 2);
    EXPECT_NEAR(dot(chart.u, chart.v), 0, 1e-9 * length(chart.u) * length(chart.v));
    EXPECT_LE(std::max(length(chart.u), length(chart.v)), 1.001 / texels_per_metre) << "at least as fine as asked for";
    EXPECT_GT(dot(cross(chart.u, chart.v), chart.normal), 0) << "not mirrored";
    for (const std::uint32_t t : chart.triangles) {
      ++times[t];
      EXPECT_EQ(result.surface[t], chart.surface);
      std::array<std::array<double, 2>, 3> at;
      for (std::size_t k = 0; k < 3; ++k) at[k] = chart.texel_of(result.points[result.triangles[t][k]]);
      EXPECT_GE((at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) - (at[1][1] - at[0][1]) * (at[2][0] - at[0][0]), -1e-9);
    }
  }
  EXPECT_TRUE(std::ranges::all_of(times, [](int n) { return n == 1; }));
}

TEST(SmallestRectangle, IsTheTurnedSquareItself) {
  const double c = std::cos(0.3), s = std::sin(0.3);
  std::vector<std::array<double, 2>> points;
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 8; ++i) points.push_back({c * i - s * j + 100, s * i + c * j});
  const TurnedRectangle r = smallest_rectangle(points);
  const double a = r.high[0] - r.low[0], b = r.high[1] - r.low[1];
  EXPECT_NEAR(a * b, 32, 1e-9);
  EXPECT_NEAR(std::max(a, b), 8, 1e-9);
}

TEST(FindCharts, ATurnedWallIsOneChartThatFillsItsRectangle) {
  LitSurfaces wall;
  wall.add_surface("wall");
  const Vec3 along = Vec3{std::cos(0.7), std::sin(0.7), 0} * 4;
  wall.add_grid(rectangle({30, 20, 1}, along, {0, 0, 2.5}), 8, 5, one);
  const auto charts = find_charts(wall.result, 20);
  expect_sound(wall.result, charts, 20);
  ASSERT_EQ(charts.size(), 1u);
  EXPECT_EQ(std::max(charts[0].width, charts[0].height), 81);  // both ends are texel centres
  EXPECT_EQ(std::min(charts[0].width, charts[0].height), 51);
  EXPECT_EQ(charts[0].used, 83u * 53);
  EXPECT_NEAR(charts[0].area, 10, 1e-9);
  EXPECT_TRUE(charts[0].is_planar);
}

TEST(FindCharts, TwoSidesOfASheetAndTwoSurfacesOfOnePlaneArePartedAsTheirPointsAre) {
  LitSurfaces sheet;
  sheet.add_surface("sheet");
  sheet.add_grid(rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 2, 2, one);
  sheet.add_grid(rectangle({0, 0, 0}, {0, 1, 0}, {1, 0, 0}), 2, 2, one);
  sheet.add_surface("beside");
  sheet.add_grid(rectangle({1, 0, 0}, {1, 0, 0}, {0, 1, 0}), 2, 2, one);
  const auto charts = find_charts(sheet.result, 10);
  expect_sound(sheet.result, charts, 10);
  EXPECT_EQ(charts.size(), 3u);
}

TEST(FindCharts, ACylinderIsCutIntoStripsThatAreNearlyFlat) {
  LitSurfaces column;
  column.add_surface("column");
  column.add_grid(
      [](double s, double t) {
        const double a = 2 * std::numbers::pi * s;
        return Vec3{std::cos(a), std::sin(a), 3 * t};
      },
      72, 6, one);
  const auto charts = find_charts(column.result, 20);
  expect_sound(column.result, charts, 20);
  EXPECT_GE(charts.size(), 7u);  // 50 degrees each
  EXPECT_LE(charts.size(), 16u);
}

TEST(FindCharts, ASpiralRampLiesOverItselfInNoChart) {
  // Two turns of a helix: seen from above they cover each other, and its normal hardly changes.
  LitSurfaces ramp;
  ramp.add_surface("ramp");
  ramp.add_grid(
      [](double s, double t) {
        const double a = 4 * std::numbers::pi * s, r = 4 + 2 * t;
        return Vec3{r * std::cos(a), r * std::sin(a), 4 * s};
      },
      96, 4, one);
  for (auto& t : ramp.result.triangles) std::swap(t[1], t[2]);
  const double texels_per_metre = 5;
  const auto charts = find_charts(ramp.result, texels_per_metre);
  expect_sound(ramp.result, charts, texels_per_metre);
  for (const AtlasChart& chart : charts) {
    double lowest = 1e9, highest = -1e9;
    for (const std::uint32_t t : chart.triangles)
      for (const std::uint32_t p : ramp.result.triangles[t]) {
        lowest = std::min(lowest, ramp.result.points[p].z), highest = std::max(highest, ramp.result.points[p].z);
      }
    EXPECT_LE(highest - lowest, 2.1) << "more than a turn";
  }
}

TEST(FindCharts, AnLShapedFloorIsCutSoThatItsRectanglesAreFull) {
  LitSurfaces floor;
  floor.add_surface("floor");
  floor.add_grid(rectangle({0, 0, 0}, {10, 0, 0}, {0, 10, 0}), 20, 20, one,
                 [](int i, int j) { return i < 6 || j < 6; });
  const auto charts = find_charts(floor.result, 20);
  expect_sound(floor.result, charts, 20);
  double used = 0, all = 0;
  for (const AtlasChart& c : charts) used += static_cast<double>(c.used), all += (c.width + 2.0) * (c.height + 2.0);
  EXPECT_GT(used / all, 0.85);
  EXPECT_LE(charts.size(), 4u);
}

TEST(FindCharts, AFloorIsCutAlongAPartitionThatEndsInIt) {
  // A slit from the rim to the middle: points along it are there twice, as a solve leaves them under a thin wall.
  LitSurfaces floor;
  floor.add_surface("floor");
  floor.add_grid(rectangle({0, 0, 0}, {8, 0, 0}, {0, 8, 0}), 16, 16, one);
  std::vector<std::uint32_t> twin(floor.result.points.size(), 0);
  for (std::uint32_t p = 0; p < twin.size(); ++p)
    if (const Vec3 at = floor.result.points[p]; at.x == 4 && at.y < 4) twin[p] = floor.add_point(at, 1.5);
  for (auto& triangle : floor.result.triangles) {
    double middle = 0;
    for (const std::uint32_t p : triangle) middle += floor.result.points[p].x / 3;
    for (std::uint32_t& p : triangle)
      if (middle > 4 && twin[p]) p = twin[p];
  }
  const auto charts = find_charts(floor.result, 20);
  expect_sound(floor.result, charts, 20);
  EXPECT_GE(charts.size(), 2u);
  for (const AtlasChart& chart : charts) {
    bool left = false, right = false;
    for (const std::uint32_t t : chart.triangles)
      for (const std::uint32_t p : floor.result.triangles[t])
        if (const Vec3 at = floor.result.points[p]; at.y < 3.9) left = left || at.x < 4, right = right || at.x > 4;
    EXPECT_FALSE(left && right);
  }
}

TEST(FindCharts, WhatHasNoAreaOrNearlyNoneHasAPlaceToo) {
  LitSurfaces odd;
  odd.add_surface("odd");
  const auto point = odd.add_point({1, 1, 1}, 5);
  odd.add_triangle(point, point, point);
  odd.add_triangle(odd.add_point({0, 0, 0}, 1), odd.add_point({1, 0, 0}, 1), odd.add_point({2, 0, 0}, 1));
  odd.add_triangle(odd.add_point({0, 0, 0}, 1), odd.add_point({1, 0, 0}, 1), odd.add_point({1, 1e-6, 0}, 1));
  odd.add_triangle(odd.add_point({0, 0, 0}, 1), odd.add_point({1e-6, 0, 0}, 1), odd.add_point({0, 1e-6, 0}, 1));
  const auto charts = find_charts(odd.result, 20);
  expect_sound(odd.result, charts, 20);
  for (const AtlasChart& c : charts) {
    EXPECT_LE(c.width, 42);
    EXPECT_LE(c.height, 42);
    EXPECT_GT(c.used, 0u);
  }
}

TEST(FindCharts, ARoadOfKilometresIsCutIntoPiecesOfAPicture) {
  LitSurfaces road;
  road.add_surface("road");
  road.add_grid(rectangle({0, 0, 0}, {5000, 0, 0}, {0, 6, 0}), 500, 1, one);
  const auto charts = find_charts(road.result, 10);
  expect_sound(road.result, charts, 10);
  for (const AtlasChart& c : charts) EXPECT_LE(std::max(c.width, c.height), kLongestChart);
  EXPECT_LE(charts.size(), 40u);
}

}  // namespace
}  // namespace clerestory
