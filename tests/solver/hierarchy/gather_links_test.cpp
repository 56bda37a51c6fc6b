#include "solver/hierarchy/gather_links.h"

#include <gtest/gtest.h>

#include "solver/hierarchy/balance.h"
#include "solver/hierarchy/build_tree.h"
#include "solver/hierarchy/trace_links.h"
#include "solver/illumination/light_rows.h"
#include "solver/model/parallel.h"
#include "tests/support/many_lights.h"

namespace clerestory {
namespace {

/// Links of a room in which some receivers hand down.
struct LinkedRoom {
  test::ManyLights room;
  ElementTree tree = build_tree(room.patches, room.patches.M);
  Transport transport;
  std::size_t n = room.patches.patch_count();

  explicit LinkedRoom(int channels) : room(channels) {
    DirectLight none;
    none.E = Field(n, channels);
    transport = trace_links(Illumination(room.problem), tree, {}, none,
                            {.bundle_rays = 64, .bright_rays = 16, .cluster_diameter = 0.1});
  }
  /// Light of any kind, over nine orders of magnitude.
  Field light(int lanes) const {
    Field x(n, lanes);
    for (std::size_t k = 0; k < x.value.size(); ++k) x.value[k] = std::pow(10.0, static_cast<double>(k * 7 % 10)) + 1;
    return x;
  }
};

TEST(LinkGather, FindsInEightLanesWhatOneLaneFinds) {
  const LinkedRoom r(1);
  const Field light = r.light(8);
  std::vector<Lanes<8>> B(r.n), E(r.n);
  for (std::size_t i = 0; i < r.n; ++i)
    for (std::size_t l = 0; l < 8; ++l) B[i].lane[l] = light.value[8 * i + l];
  LinkGather<8>(r.tree, r.transport)(B, E);
  for (std::size_t l = 0; l < 8; ++l) {
    Field nodes, E_of_lane(r.n, 1);
    pull(r.tree, one_layer(light, l, 1), nodes);
    gather_and_push(r.transport, r.tree, nodes, E_of_lane);
    for (std::size_t i = 0; i < r.n; ++i)  // a float's rounding, of each node and of each sum of eight
      EXPECT_NEAR(E[i].lane[l], E_of_lane[i][0], 3e-7 * E_of_lane[i][0]) << i << ", lane " << l;
  }
}

TEST(BalanceOf, SpacesThatLightEachOtherAreBalancedAllTheSame) {
  // Few patches a space, or one, though they see hardly anything but patches of others: corrected one by one, all
  // overshoot, and nothing of that is seen in their own space.
  LinkedRoom r(1);
  const Field M = r.light(1), E_direct(r.n, 1);
  const Balanced right = balance(r.room.patches, r.tree, r.transport, M, E_direct, {}, 1e-9);
  ASSERT_EQ(right.stop, StopReason::converged);
  for (const std::size_t patches : {4, 1}) {
    r.transport.spaces = r.n / patches;
    for (std::uint32_t i = 0; i < r.n; ++i) r.transport.space[i] = i % static_cast<std::uint32_t>(r.transport.spaces);
    const Balanced parted = balance(r.room.patches, r.tree, r.transport, M, E_direct, {}, 1e-9);
    ASSERT_EQ(parted.stop, StopReason::converged);
    for (std::size_t i = 0; i < r.n; ++i) EXPECT_NEAR(parted.E[i][0], right.E[i][0], 1e-6 * right.E[i][0]);
  }
}

class Balance : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(Balance, OfManyRightHandSidesIsThatOfEach) {
  const auto [channels, count] = GetParam();
  const LinkedRoom r(channels);
  const Field M = r.light(channels * count), E_direct(r.n, channels * count);
  const Balanced all = balance(r.room.patches, r.tree, r.transport, M, E_direct, {}, 1e-9);
  ASSERT_EQ(all.stop, StopReason::converged);
  for (std::size_t s = 0; s < static_cast<std::size_t>(count); ++s) {
    const Balanced one =
        balance(r.room.patches, r.tree, r.transport, one_layer(M, s, channels), Field(r.n, channels), {}, 1e-9);
    const Field E = one_layer(all.E, s, channels), B = one_layer(all.B, s, channels);
    for (std::size_t k = 0; k < E.value.size(); ++k) {
      EXPECT_NEAR(E.value[k], one.E.value[k], 1e-6 * one.E.value[k]);
      EXPECT_NEAR(B.value[k], one.B.value[k], 1e-6 * one.B.value[k]);
    }
    EXPECT_NEAR(all.energy[s].absorbed, one.energy[0].absorbed, 1e-6 * one.energy[0].absorbed);
    EXPECT_NEAR(all.energy[s].escaped, one.energy[0].escaped, 1e-6 * one.energy[0].escaped);
  }
}

TEST_P(Balance, IsTheSameForAnyNumberOfThreads) {
  const auto [channels, count] = GetParam();
  const LinkedRoom r(channels);
  const Field M = r.light(channels * count), E_direct(r.n, channels * count);
  std::vector<Field> E;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    E.push_back(balance(r.room.patches, r.tree, r.transport, M, E_direct, {}, 1e-6).E);
  }
  set_thread_count(0);
  EXPECT_EQ(E[0].value, E[1].value);
}

INSTANTIATE_TEST_SUITE_P(Lanes, Balance,
                         testing::Values(std::pair{1, 1}, std::pair{1, 2}, std::pair{1, 8}, std::pair{1, 11},
                                         std::pair{3, 1}, std::pair{3, 5}),
                         [](const auto& lanes) {
                           return std::to_string(lanes.param.second) + "of" + std::to_string(lanes.param.first);
                         });

}  // namespace
}  // namespace clerestory
