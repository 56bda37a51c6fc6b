#include "solver/methods/form_factor_matrix.h"

#include <atomic>
#include <cmath>

#include <gtest/gtest.h>

#include "solver/model/error.h"
#include "solver/model/parallel.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using test::PatchBuilder;
using test::RoomWithBlocks;

RoomWithBlocks small_room() { return {.room_cells = {8, 6, 5}, .block_cells = 2}; }

FormFactorMatrix raw_matrix(const PatchSet& patches) {
  return form_factor_matrix(patches, RayScene(patches), {.close_rows = false});
}

TEST(FormFactorMatrix, RowsOfAnEmptyRoomSumToOneByQuadratureAlone) {
  const PatchSet patches = PatchBuilder().box({0, 0, 0}, {5, 0, 0}, {0, 4, 0}, {0, 0, 3}, {10, 8, 6}, true).build();
  const FormFactorMatrix F = raw_matrix(patches);
  EXPECT_EQ(F.pairs_sampled, 0u);
  // Quadrature errors of single pairs are below 1e-4 and both ways; float leaves 1e-8 a factor.
  for (const double sum : F.raw_row_sum) EXPECT_NEAR(sum, 1, 1e-5);
}

TEST(FormFactorMatrix, EveryRowOfARoomWithBlocksSumsToOneBeforeAnyCorrection) {
  const PatchSet patches = test::room_of_2160_patches().build();
  ASSERT_EQ(patches.patch_count(), 2160u);
  const FormFactorMatrix F = raw_matrix(patches);
  for (std::size_t i = 0; i < F.n; ++i) EXPECT_NEAR(F.raw_row_sum[i], 1, 1e-3) << "row " << i;  // the bar
  for (const float f : F.value) {
    ASSERT_GE(f, 0);
    ASSERT_LE(f, 1);
  }
}

TEST(FormFactorMatrix, ClosedRowsAreExactAfterwardsAndReciprocityStays) {
  const PatchSet patches = small_room().build();
  const FormFactorMatrix F = form_factor_matrix(patches, RayScene(patches));
  for (std::size_t i = 0; i < F.n; ++i) {
    EXPECT_TRUE(F.closed[i]) << "row " << i;
    EXPECT_NEAR(F.row_sum[i], 1, 2e-7) << "row " << i;
    for (std::size_t j = 0; j < i; ++j) {
      const double there = patches.area[i] * F.at(i, j), back = patches.area[j] * F.at(j, i);
      EXPECT_NEAR(there, back, 4e-7 * (there + back));  // two roundings to float
    }
  }
}

TEST(FormFactorMatrix, OpenRoomsKeepTheirRowSums) {
  // A room without its ceiling: what the floor loses is its factor to the opening, known from the closed room.
  PatchBuilder builder;
  builder.box({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, true);
  PatchSet patches = builder.build();
  std::vector<bool> wanted(2 * patches.triangle_count(), false);
  for (std::size_t t = 0; t < patches.triangle_count(); ++t)
    wanted[2 * t] = t != 2 && t != 3;  // triangles 2, 3: ceiling
  for (const std::size_t t : {std::size_t{3}, std::size_t{2}}) {
    const auto at = static_cast<std::ptrdiff_t>(t);
    patches.corners.erase(patches.corners.begin() + at);
    patches.side_material.erase(patches.side_material.begin() + at);
    patches.side_surface.erase(patches.side_surface.begin() + at);
  }
  make_patches(patches, std::vector<bool>(2 * patches.triangle_count(), true));
  const FormFactorMatrix F = form_factor_matrix(patches, RayScene(patches));
  // Patches 0 and 2 are the inner sides of the floor's triangles; together they send 0.199825 (C-11) to the opening.
  EXPECT_NEAR((F.row_sum[0] + F.row_sum[2]) / 2, 1 - 0.199824895698387, 1e-4);
  EXPECT_FALSE(F.closed[0]);
}

TEST(FormFactorMatrix, HasTheSameBitsForOneThreadAndForTwo) {
  const PatchSet patches = small_room().build();
  const RayScene rays(patches);
  set_thread_count(1);
  const FormFactorMatrix one = form_factor_matrix(patches, rays);
  set_thread_count(2);
  const FormFactorMatrix two = form_factor_matrix(patches, rays);
  set_thread_count(0);
  EXPECT_EQ(one.value, two.value);
  EXPECT_EQ(one.row_sum, two.row_sum);
  EXPECT_EQ(one.row_error, two.row_error);
}

TEST(FormFactorMatrix, ASealedNeighbourRoomGetsNothing) {
  PatchBuilder builder;
  builder.box({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {3, 3, 3}, true);
  const std::size_t first_room = 2 * 6 * 9;
  builder.box({2.1, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {3, 3, 3}, true);
  const PatchSet patches = builder.build();
  const FormFactorMatrix F = form_factor_matrix(patches, RayScene(patches));
  for (std::size_t i = 0; i < first_room; ++i)
    for (std::size_t j = first_room; j < F.n; ++j) ASSERT_EQ(F.at(i, j), 0) << i << " " << j;
}

TEST(FormFactorMatrix, RefusesMoreMemoryThanAllowedAndSaysWhatToDo) {
  const PatchSet patches = small_room().build();
  try {
    require_matrix_fits(patches.patch_count(), {.memory_limit = form_factor_bytes(patches.patch_count())});
    EXPECT_THROW(require_matrix_fits(patches.patch_count(), {.memory_limit = 1000}), InputError);
    form_factor_matrix(patches, RayScene(patches), {.memory_limit = 1000});
    FAIL() << "a matrix above the limit was made";
  } catch (const InputError& e) {
    const std::string message = e.what();
    EXPECT_NE(message.find(std::to_string(patches.patch_count())), std::string::npos) << message;
    EXPECT_NE(message.find("--max-element"), std::string::npos) << message;
    EXPECT_NE(message.find("--method progressive"), std::string::npos) << message;
  }
  EXPECT_LT(static_cast<double>(form_factor_bytes(2160)), 1.2 * 2160 * 2160 * 4);
}

TEST(FormFactorMatrix, StopsWhenAskedAndSaysSo) {
  const PatchSet patches = small_room().build();
  const std::atomic<bool> interrupted{true};
  Monitor monitor;
  monitor.interrupted = [&] { return interrupted.load(); };
  const FormFactorMatrix F = form_factor_matrix(patches, RayScene(patches), {}, monitor);
  EXPECT_FALSE(F.complete);
  EXPECT_EQ(F.n, patches.patch_count());
}

}  // namespace
}  // namespace clerestory
