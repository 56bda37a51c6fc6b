// Colours of numbers, and lines of equal value.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "io/picture/colour_map.h"
#include "io/picture/iso_lines.h"

namespace clerestory {
namespace {

TEST(Viridis, HasTheColoursOfItsAuthors) {
  // 0, 0.5 and 1 of the published table: #440154, #21918c, #fde725.
  const std::array<double, 3> expected[] = {{0.267, 0.005, 0.329}, {0.128, 0.567, 0.551}, {0.993, 0.906, 0.144}};
  for (int i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(viridis(0.5 * i)[k], expected[i][k], 0.016) << i << " " << k;
  EXPECT_EQ(viridis(-1), viridis(0));
  EXPECT_EQ(viridis(2), viridis(1));
}

TEST(PlaceInRange, IsLinearOrByLogarithmAndClipped) {
  EXPECT_DOUBLE_EQ(place_in_range(30, 10, 110, false), 0.2);
  EXPECT_DOUBLE_EQ(place_in_range(100, 10, 1000, true), 0.5);
  EXPECT_EQ(place_in_range(0, 10, 1000, true), 0);
  EXPECT_EQ(place_in_range(1e9, 10, 1000, true), 1);
  EXPECT_EQ(place_in_range(5, 5, 5, false), 1);
}

TEST(IsoLines, GoAroundAConeInOnePiece) {
  // z = 0 plane, value = 10 - distance from the middle: the line of 7 is the circle of radius 3.
  constexpr int n = 80;
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<float> value;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = 10.0 * i / n - 5, y = 10.0 * j / n - 5;
      points.push_back({x, y, 0});
      value.push_back(static_cast<float>(10 - std::hypot(x, y)));
      if (i == n || j == n) continue;
      const auto a = static_cast<std::uint32_t>(j * (n + 1) + i);
      triangles.push_back({a, a + 1, a + n + 2});
      triangles.push_back({a, a + n + 2, a + n + 1});
    }
  const std::vector<double> levels = {7, 100};
  const std::vector<IsoLine> lines = iso_lines(points, triangles, value, levels);
  ASSERT_EQ(lines.size(), 1u) << "one circle, and nothing of 100";
  EXPECT_EQ(lines[0].level, 7);
  EXPECT_LT(length(lines[0].points.front() - lines[0].points.back()), 1e-12) << "closed";
  double around = 0;
  for (std::size_t k = 1; k < lines[0].points.size(); ++k) {
    EXPECT_NEAR(length(lines[0].points[k]), 3, 10.0 / n * 10.0 / n);  // second order in the grid's step
    around += length(lines[0].points[k] - lines[0].points[k - 1]);
  }
  EXPECT_NEAR(around, 6 * std::numbers::pi, 0.02);
}

}  // namespace
}  // namespace clerestory
