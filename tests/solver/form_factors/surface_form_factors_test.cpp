#include "solver/form_factors/surface_form_factors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "solver/form_factors/point_to_polygon.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using test::PatchBuilder;

/// Unit floor and ceiling one metre apart, as two objects; and a screen of half their size between them, if wanted.
PatchSet floor_and_ceiling(bool with_screen) {
  PatchBuilder builder;
  builder.surface("floor").rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  builder.surface("ceiling").rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0});
  if (with_screen) builder.surface("screen").rectangle({0.25, 0.25, 0.5}, {0.5, 0, 0}, {0, 0.5, 0});
  return builder.build();
}

const SurfaceFactor& factor(const SurfaceFactors& factors, const PatchGroups& groups, const std::string& from,
                            const std::string& to) {
  for (const SurfaceFactor& f : factors.rows)
    if (groups.name[f.from] == from && groups.name[f.to] == to) return f;
  throw std::runtime_error("no row " + from + " -> " + to);
}

TEST(SurfaceFormFactors, OpenPairsAreExactAndSayThatNothingBlocks) {
  const PatchSet patches = floor_and_ceiling(false);
  const PatchGroups groups = group_patches(patches, GroupBy::object);
  const SurfaceFactors factors = surface_form_factors(patches, RayScene(patches), groups);
  EXPECT_EQ(factors.rows.size(), 4u);
  const SurfaceFactor& up = factor(factors, groups, "floor", "ceiling");
  EXPECT_NEAR(up.F, 0.199824895698387, 1e-12);  // Howell C-11
  EXPECT_EQ(up.std_error, 0);
  EXPECT_EQ(up.visibility, 1);
  EXPECT_EQ(factor(factors, groups, "floor", "floor").F, 0);
}

TEST(SurfaceFormFactors, BlockedPairsAreSampledAndFacesActOnTheirFrontOnly) {
  const PatchSet patches = floor_and_ceiling(true);
  const PatchGroups groups = group_patches(patches, GroupBy::object);
  const SurfaceFactors factors = surface_form_factors(patches, RayScene(patches), groups);
  const SurfaceFactor& up = factor(factors, groups, "floor", "ceiling");
  EXPECT_NEAR(up.F, 0.0995062945989848, 4 * up.std_error);  // row OCC01 of the reference table
  EXPECT_LT(up.std_error, 5e-4);
  EXPECT_NEAR(up.visibility, 0.0995062945989848 / 0.199824895698387, 4 * up.std_error / 0.2);
  EXPECT_EQ(factor(factors, groups, "floor", "screen").F, 0);  // its front looks up
  EXPECT_GT(factor(factors, groups, "screen", "ceiling").F, 0.1);
}

TEST(SurfaceFormFactors, AConcaveGroupSeesItself) {
  const PatchSet patches =
      PatchBuilder().surface("room").box({0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 1}, {1, 1, 1}, true).build();
  const SurfaceFactors factors =
      surface_form_factors(patches, RayScene(patches), group_patches(patches, GroupBy::object));
  ASSERT_EQ(factors.rows.size(), 1u);
  EXPECT_NEAR(factors.rows[0].F, 1, 1e-12);
  EXPECT_NEAR(factors.row_sum[0], 1, 1e-12);
}

TEST(SurfaceFormFactors, ClosedRoomWithBlocksHasRowSumsOfOneAndReciprocity) {
  const PatchSet patches = test::RoomWithBlocks{.room_cells = {1, 1, 1}, .block_cells = 1}.build();
  const PatchGroups groups = group_patches(patches, GroupBy::patch);
  const SurfaceFactors factors = surface_form_factors(patches, RayScene(patches), groups, {.most_samples = 4096});
  for (std::size_t g = 0; g < groups.name.size(); ++g) {
    double variance = 0;
    for (const SurfaceFactor& f : factors.rows)
      if (f.from == g) variance += f.std_error * f.std_error;
    EXPECT_NEAR(factors.row_sum[g], 1, 4 * std::sqrt(variance) + 1e-9) << "patch " << g;
  }
  EXPECT_GT(factors.pairs_sampled, 100u);
}

/// Unit floor and ceiling a metre apart, and half-way a plate with a square hole in its middle.
PatchSet plate_with_hole(double width) {
  const double low = 0.5 - width / 2, high = 0.5 + width / 2, z = 0.5;
  PatchBuilder b;
  b.surface("floor").rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  b.surface("ceiling").rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0});
  b.surface("plate")
      .rectangle({-1, -1, z}, {3, 0, 0}, {0, low + 1, 0})
      .rectangle({-1, high, z}, {3, 0, 0}, {0, low + 1, 0});
  b.rectangle({-1, low, z}, {low + 1, 0, 0}, {0, width, 0}).rectangle({high, low, z}, {low + 1, 0, 0}, {0, width, 0});
  return b.build();
}
/// What a floor point sees of the ceiling is the hole's shadow on it, Lambert's sum of that; mean over n x n points.
double floor_to_ceiling_through_hole(double width, int n) {
  const double low = 0.5 - width / 2, high = 0.5 + width / 2;
  double sum = 0;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      const double x = (a + 0.5) / n, y = (b + 0.5) / n;
      const double x0 = std::max(0.0, 2 * low - x), x1 = std::min(1.0, 2 * high - x);
      const double y0 = std::max(0.0, 2 * low - y), y1 = std::min(1.0, 2 * high - y);
      if (x0 >= x1 || y0 >= y1) continue;
      const std::array<Vec3, 4> seen{{{x0, y0, 1}, {x0, y1, 1}, {x1, y1, 1}, {x1, y0, 1}}};
      sum += point_to_polygon({x, y, 0}, {0, 0, 1}, seen);
    }
  return sum / n / n;
}

TEST(SurfaceFormFactors, RaysGoOnUntilTheStandardErrorIsAFiveHundredthOfTheFactor) {
  for (const double width : {0.16, 0.1}) {  // 6.6 and 2.7 % are visible
    const double exact = floor_to_ceiling_through_hole(width, 512);
    ASSERT_NEAR(exact / floor_to_ceiling_through_hole(width, 256), 1, 2e-4);
    const PatchSet patches = plate_with_hole(width);
    const PatchGroups groups = group_patches(patches, GroupBy::object);
    double square = 0;
    constexpr int kSeeds = 8;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      const SurfaceFactors factors =
          surface_form_factors(patches, RayScene(patches), groups, {.seed = static_cast<std::uint64_t>(seed)});
      const SurfaceFactor& up = factor(factors, groups, "floor", "ceiling");
      EXPECT_TRUE(up.reached()) << up.std_error / up.F;
      EXPECT_NEAR(up.F, exact, 4 * up.std_error) << width;
      square += std::pow((up.F - exact) / up.std_error, 2) / kSeeds;
    }
    // What is said of the error is what it is: chi-square of 8 degrees of freedom is in this range but for 1 in 1,000.
    EXPECT_GT(square, 0.1) << width;
    EXPECT_LT(square, 3.3) << width;
  }
}

TEST(SurfaceFormFactors, WhereRaysAreUsedUpTheStandardErrorSaysWhatWasReached) {
  const PatchSet patches = plate_with_hole(0.1);
  const PatchGroups groups = group_patches(patches, GroupBy::object);
  const SurfaceFactors factors = surface_form_factors(patches, RayScene(patches), groups, {.most_samples = 2048});
  const SurfaceFactor& up = factor(factors, groups, "floor", "ceiling");
  EXPECT_FALSE(up.reached());
  EXPECT_NEAR(up.F, floor_to_ceiling_through_hole(0.1, 512), 4 * up.std_error);
  EXPECT_LE(factors.rays, 2 * 4 * (2048u + 17 * 256));  // both ways, four pairs of triangles: rays, and pilots of parts
  EXPECT_TRUE(factor(factors, groups, "floor", "plate").reached());
}

TEST(SurfaceFormFactors, NoPairHasMoreRaysThanWereAskedFor) {
  const PatchSet patches = plate_with_hole(0.1);
  const PatchGroups groups = group_patches(patches, GroupBy::object);
  const auto rays_for = [&](int most) {
    const SurfaceFactors factors =
        surface_form_factors(patches, RayScene(patches), groups, {.most_samples = most, .seed = 3});
    EXPECT_GT(factors.pairs_sampled, 0u);
    return factors.rays / factors.pairs_sampled;
  };
  EXPECT_EQ(rays_for(300), 256u);        // the pilot is all of it
  EXPECT_EQ(rays_for(600), 256u + 512);  // the pilot, and what counts
  EXPECT_LE(rays_for(1000), 256u + 768);
}

TEST(SurfaceFormFactors, WhatAGroupFindsDoesNotDependOnHowManyPairsAreHeldAtATime) {
  const PatchSet patches = test::RoomWithBlocks{.room_cells = {3, 3, 2}, .block_cells = 1}.build();
  const RayScene rays(patches);
  const PatchGroups groups = group_patches(patches, GroupBy::object);
  const SurfaceFactors at_once = surface_form_factors(patches, rays, groups, {.most_samples = 4096});
  const SurfaceFactors in_blocks =
      surface_form_factors(patches, rays, groups, {.most_samples = 4096, .pairs_held = 100});
  EXPECT_EQ(in_blocks.pairs_sampled, at_once.pairs_sampled);
  EXPECT_EQ(in_blocks.pairs_unblocked, at_once.pairs_unblocked);
  const auto pilots = static_cast<double>(256 * at_once.pairs_sampled);
  // Some groups were looked at twice, and no more was spent on what counts.
  EXPECT_GT(static_cast<double>(in_blocks.rays), static_cast<double>(at_once.rays) + 0.1 * pilots);
  EXPECT_LT(static_cast<double>(in_blocks.rays) - pilots, 1.1 * static_cast<double>(at_once.rays));
  ASSERT_EQ(in_blocks.rows.size(), at_once.rows.size());
  for (std::size_t k = 0; k < at_once.rows.size(); ++k) {
    const SurfaceFactor &a = at_once.rows[k], &b = in_blocks.rows[k];
    EXPECT_NEAR(a.F, b.F, 4 * std::hypot(a.std_error, b.std_error) + 1e-12) << k;
    EXPECT_EQ(a.reached(), b.reached()) << k << ": " << a.std_error / a.F << ", " << b.std_error / b.F;
    EXPECT_NEAR(b.std_error, a.std_error, 0.5 * a.std_error) << k;
  }
}

TEST(GroupPatches, NamesSurfacesByTheirPlane) {
  const PatchSet patches =
      PatchBuilder().surface("room").box({0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 1}, {2, 2, 2}, true).build();
  const PatchGroups groups = group_patches(patches, GroupBy::surface);
  ASSERT_EQ(groups.name.size(), 6u);
  EXPECT_EQ(groups.name[0], "room/1");
  EXPECT_EQ(group_patches(patches, GroupBy::patch).name.size(), patches.patch_count());
}

}  // namespace
}  // namespace clerestory
