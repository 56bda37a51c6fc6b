#include "solver/form_factors/shaft.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "solver/form_factors/sampled.h"
#include "solver/model/random_stream.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

TEST(Blockers, TheWallsOfAConvexRoomBlockNothing) {
  const PatchSet empty = test::PatchBuilder().box({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2}, {4, 3, 2}, true).build();
  EXPECT_TRUE(Blockers(empty).empty());
  const test::RoomWithBlocks room{.room_cells = {4, 4, 3}, .block_cells = 2};
  EXPECT_EQ(Blockers(room.build()).triangle_count(), 2u * 6 * 4 * 2);  // the faces of both blocks
}

TEST(PairShaft, WhatItCallsOpenIsOpenAndWhatScreensHideIsHidden) {
  // Against rays, over random pairs of a room with two turned blocks: the tests may call a pair doubtful that is not,
  // but never the other way round.
  const PatchSet patches = test::RoomWithBlocks{.room_cells = {8, 6, 5}, .block_cells = 2}.build();
  const RayScene rays(patches);
  const Blockers blockers(patches);
  RandomStream random(3);
  int open = 0, hidden = 0, doubtful = 0;
  std::vector<const Blocker*> near;
  std::vector<const Screen*> screens;
  for (int k = 0; k < 20'000; ++k) {
    const auto n = static_cast<double>(patches.patch_count());
    const PatchId i{static_cast<std::size_t>(random.uniform() * n)}, j{static_cast<std::size_t>(random.uniform() * n)};
    const auto p = patches.corner_positions(i), q = patches.corner_positions(j);
    const SampledVisibility V =
        sample_visibility_quick({p, patches.normal[i]}, {q, patches.normal[j]}, rays, static_cast<std::uint64_t>(k));
    if (V.rays == 0) continue;  // they do not face each other
    blockers.in_shaft(Box::around(p), Box::around(q), near);
    blockers.screens_in_shaft(Box::around(p), Box::around(q), screens);
    const PairShaft shaft(p, patches.normal[i], q, patches.normal[j], blockers.touching());
    const bool reached = std::ranges::any_of(near, [&](const Blocker* b) { return shaft.reached_by(*b); });
    const bool covered =
        std::ranges::any_of(screens, [&](const Screen* s) { return s->hides(p, q, blockers.touching()); });
    if (!reached) {
      EXPECT_EQ(V.value, 1) << "patches " << i.value << " and " << j.value;
    }
    if (covered) {
      EXPECT_EQ(V.value, 0) << "patches " << i.value << " and " << j.value;
    }
    open += !reached, hidden += covered, doubtful += reached && !covered;
  }
  EXPECT_GT(open, 5'000);
  EXPECT_GT(hidden, 500);
  EXPECT_GT(doubtful, 500);
}

}  // namespace
}  // namespace clerestory
