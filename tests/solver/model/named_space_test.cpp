#include "solver/model/named_space.h"

#include <gtest/gtest.h>

namespace clerestory {
namespace {

/// A prism over a polygon in plan, counter-clockwise and convex, from z = 1 to 4; `turned` walls are wound inwards.
NamedSpace prism(const std::vector<Vec3>& plan, bool turned = false) {
  NamedSpace space;
  const auto n = static_cast<std::uint32_t>(plan.size());
  for (const double z : {1.0, 4.0})
    for (const Vec3& p : plan) space.vertices.push_back({p.x, p.y, z});
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    space.corner.insert(space.corner.end(), {a, b, c});
  };
  for (std::uint32_t k = 1; k + 1 < n; ++k) add(0, k + 1, k), add(n, n + k, n + k + 1);
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    if (turned)
      add(k, n + next, next), add(k, n + k, n + next);
    else
      add(k, next, n + next), add(k, n + next, n + k);
  }
  return space;
}

TEST(NamedSpaceOf, APrismHasItsPlanItsHeightAndItsVolumeHoweverItIsWound) {
  const std::vector<Vec3> house{{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 3, 0}, {0, 2, 0}};  // 8 + 2 m2
  for (const bool turned : {false, true}) {
    const NamedSpace space = prism(house, turned);
    EXPECT_NEAR(floor_area(space), 10, 1e-12);
    EXPECT_NEAR(volume(space), 30, 1e-12);
    EXPECT_NEAR(height(space), 3, 1e-12);
  }
  EXPECT_EQ(volume(NamedSpace{}), 0);
}

TEST(NamedSpaceOf, TheLineThroughAPointIsInsideOnceAlsoOnEdgesOfItsTriangles) {
  const NamedSpace space = prism({{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}});
  for (const auto& [x, y] : {std::pair{1.0, 1.0}, {2.0, 1.0}, {4.0 / 3, 2.0 / 3}}) {  // the last two on the diagonal
    const auto spans = spans_at(space, x, y);
    ASSERT_EQ(spans.size(), 1u) << x << " " << y;
    EXPECT_NEAR(spans[0].floor, 1, 1e-12);
    EXPECT_NEAR(spans[0].ceiling, 4, 1e-12);
  }
  EXPECT_TRUE(spans_at(space, 4.1, 1).empty());
}

TEST(NamedSpaceOf, WallsGoTheWayOfTheLongestOne) {
  const NamedSpace space = prism({{0, 0, 0}, {4, 3, 0}, {3.4, 3.8, 0}, {-0.6, 0.8, 0}});
  EXPECT_LT(length(wall_direction(space) - Vec3{0.8, 0.6, 0}) * length(wall_direction(space) + Vec3{0.8, 0.6, 0}),
            1e-12);
}

}  // namespace
}  // namespace clerestory
