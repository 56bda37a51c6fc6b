#include "solver/form_factors/surface_form_factors.h"

#include <gtest/gtest.h>

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
  const SurfaceFactors factors = surface_form_factors(patches, RayScene(patches), groups, {.samples = 4096});
  for (std::size_t g = 0; g < groups.name.size(); ++g) {
    double variance = 0;
    for (const SurfaceFactor& f : factors.rows)
      if (f.from == g) variance += f.std_error * f.std_error;
    EXPECT_NEAR(factors.row_sum[g], 1, 4 * std::sqrt(variance) + 1e-9) << "patch " << g;
  }
  EXPECT_GT(factors.pairs_sampled, 100u);
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
