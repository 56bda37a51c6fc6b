#include "meshing/atlas/pack_charts.h"

#include <cmath>

#include <gtest/gtest.h>

namespace clerestory {
namespace {

AtlasChart chart_of(int width, int height) {
  AtlasChart c;
  c.width = width, c.height = height;
  c.normal = {0, 0, 1}, c.u = {0.1, 0, 0}, c.v = {0, 0.1, 0};
  return c;
}

TEST(PackCharts, LeavesAGutterAroundEachAndWastesLittle) {
  std::vector<AtlasChart> charts;
  double texels = 0;
  for (int i = 0; i < 400; ++i) {
    charts.push_back(chart_of(2 + i * 37 % 90, 2 + i * i % 70));
    texels += (charts.back().width + 2.0) * (charts.back().height + 2.0);
  }
  const std::vector<AtlasChart> before = charts;
  const auto [width, height] = pack_charts(charts);
  ASSERT_GT(width, 0);
  EXPECT_EQ(width % 4, 0);
  EXPECT_EQ(height % 4, 0);
  std::vector<int> owner(static_cast<std::size_t>(width * height), -1);
  for (int i = 0; i < static_cast<int>(charts.size()); ++i) {
    const AtlasChart& c = charts[static_cast<std::size_t>(i)];
    for (int y = c.y - 1; y <= c.y + c.height; ++y)
      for (int x = c.x - 1; x <= c.x + c.width; ++x) {
        ASSERT_TRUE(x >= 0 && y >= 0 && x < width && y < height);
        int& there = owner[static_cast<std::size_t>(y * width + x)];
        ASSERT_EQ(there, -1) << "charts " << i << " and " << there;
        there = i;
      }
  }
  EXPECT_GT(texels / (double{1} * width * height), 0.9);

  // Those that were turned still have the same places in the scene.
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const AtlasChart &a = before[i], &b = charts[i];
    const Vec3 p = a.origin + a.u * 0.75 + a.v * 0.25;
    const auto [x, y] = b.texel_of(p);
    EXPECT_NEAR(length(b.origin + b.u * x + b.v * y - p), 0, 1e-12);
    EXPECT_NEAR(cross(b.u, b.v).z, 0.01, 1e-12) << "turned, not mirrored";
  }
}

TEST(PackCharts, SaysWhenNoPictureIsLargeEnough) {
  std::vector<AtlasChart> wide{chart_of(16384, 4)};
  EXPECT_EQ(pack_charts(wide)[0], 0);
  std::vector<AtlasChart> many(300, chart_of(1000, 1000));
  EXPECT_EQ(pack_charts(many)[0], 0);
  std::vector<AtlasChart> fits{chart_of(16382, 4)};
  EXPECT_GT(pack_charts(fits)[0], 0);
}

}  // namespace
}  // namespace clerestory
