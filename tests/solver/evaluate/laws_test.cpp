// Laws that hold for what a method finds, and are broken one by one.

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "solver/evaluate/light_laws.h"
#include "solver/evaluate/transport_laws.h"
#include "solver/methods/gauss_seidel.h"
#include "solver/methods/hierarchical.h"
#include "solver/run/solve.h"
#include "tests/support/room_with_blocks.h"
#include "tests/support/unjoined_lightmap.h"

namespace clerestory {
namespace {

using test::PatchBuilder;

constexpr int kRays = 256;
constexpr std::uint64_t kOtherSeed = 17;

/// Two closed rooms of floor, walls and a ceiling that glows, "hall" and "store". Nothing stands in them: their matrix
/// is made in no time.
PatchSet two_rooms() {
  PatchBuilder b;
  for (const double x : {0.0, 10.0}) {
    const Vec3 o{x, 0, 0}, u{4, 0, 0}, v{0, 3, 0}, w{0, 0, 2.5};
    b.material(0.5).surface("floor").rectangle(o, u, v, 6, 5);
    b.surface("walls").rectangle(o, v, w, 5, 4).rectangle(o + u, w, v, 4, 5);
    b.rectangle(o, w, u, 4, 6).rectangle(o + v, u, w, 6, 4);
    b.material(0.1, 50).surface("ceiling").rectangle(o + w, v, u, 5, 6);
  }
  PatchSet patches = b.build();
  patches.rooms = {"hall", "store"};
  for (std::size_t i = 0; i < patches.patch_count(); ++i)
    patches.room.push_back(patches.corner_positions(PatchId{i})[0].x < 5 ? 0 : 1);
  return patches;
}

const LawInRoom& in(const LawCheck& check, const std::string& room) {
  const auto found = std::ranges::find(check.rooms, room, &LawInRoom::room);
  if (found == check.rooms.end()) throw std::out_of_range(room);
  return *found;
}

/// Broken in the hall, and there only.
void expect_broken_in_hall(const LawCheck& check) {
  EXPECT_FALSE(check.holds());
  EXPECT_FALSE(in(check, "hall").holds()) << in(check, "hall").worst << " of " << in(check, "hall").bound;
  EXPECT_TRUE(in(check, "store").holds()) << in(check, "store").worst << " of " << in(check, "store").bound;
  EXPECT_EQ(check.worst(), &in(check, "hall"));
}

class LawsOfMatrix : public testing::Test {
 protected:
  LawCheck row_sums() const {
    return row_sums_of_matrix(patches_, F_, measure_closure({patches_, rays_, dark_}, kRays, kOtherSeed), kRays);
  }
  PatchSet patches_ = two_rooms();
  RayScene rays_{patches_};
  Lights dark_;
  FormFactorMatrix F_ = form_factor_matrix(patches_, rays_);
};

TEST_F(LawsOfMatrix, HoldInClosedRoomsWithinRounding) {
  const LawCheck reciprocity = reciprocity_of_matrix(patches_, F_), sums = row_sums();
  EXPECT_TRUE(reciprocity.holds());
  EXPECT_TRUE(sums.holds());
  ASSERT_EQ(reciprocity.rooms.size(), 2u);
  EXPECT_LE(in(sums, "hall").bound, 1e-6) << "where nothing is lost rows are exact";
}

TEST_F(LawsOfMatrix, OneFactorThatIsWrongByATenThousandthBreaksReciprocity) {
  float& factor = *std::ranges::max_element(F_.value.begin(), F_.value.begin() + static_cast<long>(F_.n));
  factor *= 1.0001f;
  expect_broken_in_hall(reciprocity_of_matrix(patches_, F_));
}

TEST_F(LawsOfMatrix, AFactorThatIsNoNumberBreaksReciprocity) {
  *std::ranges::max_element(F_.value.begin(), F_.value.begin() + static_cast<long>(F_.n)) = std::nanf("");
  expect_broken_in_hall(reciprocity_of_matrix(patches_, F_));
}

TEST_F(LawsOfMatrix, PairsThatLoseATenthOfTheirLightBothWaysBreakRowSumsAndNotReciprocity) {
  // All exchange of the first patch, as if something stood around it.
  for (std::size_t j = 0; j < F_.n; ++j) {
    F_.row_sum[j] -= 0.1 * F_.at(j, 0);
    F_.value[j] *= 0.9f, F_.value[j * F_.n] *= 0.9f;
  }
  F_.row_sum[0] = 0.9;
  F_.closed.assign(F_.n, false);
  EXPECT_TRUE(reciprocity_of_matrix(patches_, F_).holds());
  expect_broken_in_hall(row_sums());
}

TEST_F(LawsOfMatrix, WithoutTimeTheyAreNotCheckedAndSaySo) {
  const Monitor late{.progress = {}, .interrupted = {}, .deadline = std::chrono::steady_clock::now()};
  const LawCheck reciprocity = reciprocity_of_matrix(patches_, F_, late);
  EXPECT_EQ(reciprocity.not_checked, "there was no time");
  EXPECT_TRUE(reciprocity.rooms.empty());
  EXPECT_FALSE(measure_closure({patches_, rays_, dark_}, kRays, kOtherSeed, late).complete);
  EXPECT_TRUE(measure_closure({patches_, rays_, dark_}, 8, kOtherSeed).complete);
}

class LawsOfLinks : public testing::Test {
 protected:
  LawsOfLinks() {
    ElementMesh mesh(patches_, test::unjoined_lightmap(patches_));
    HierarchyOptions options;
    options.shortest_edge = 0.5, options.keep = &kept_;
    hierarchical({patches_, rays_, dark_}, mesh, options);
  }
  LawCheck reciprocity(const Monitor& monitor = {}) const {
    return reciprocity_of_links(kept_.elements, kept_.tree, kept_.transport, monitor);
  }
  LawCheck row_sums() const {
    return row_sums_of_links(kept_.elements, kept_.tree, kept_.transport,
                             measure_closure({kept_.elements, rays_, dark_}, kRays, kOtherSeed), kRays);
  }
  bool is_of(std::uint32_t node, const std::string& surface, std::uint32_t room) const {
    const std::size_t p = kept_.tree.patch[kept_.tree.first_leaf(node)];
    return kept_.elements.room[p] == room &&
           kept_.elements.surfaces[kept_.elements.surface(PatchId{p}).value] == surface;
  }
  /// Links whose light arrives on that surface of the hall.
  template <class Change>
  void change_links_to(const std::string& surface, Change change) {
    for (LinkBlock& block : kept_.transport.blocks) {
      std::size_t link = 0, row = 0;
      for (const Receiver& r : block.receivers)
        for (std::uint32_t k = 0; k < r.rows; ++k, ++row)
          for (; link < block.row_end[row]; ++link)
            if (is_of(kept_.tree.node_of_patch[kept_.tree.patch[r.first_leaf]], surface, 0)) change(block.links[link]);
    }
  }

  PatchSet patches_ = two_rooms();
  RayScene rays_{patches_};
  Lights dark_;
  KeptTransport kept_;
};

TEST_F(LawsOfLinks, WithoutTimeReciprocityIsNotCheckedAndSaysSo) {
  const Monitor late{.progress = {}, .interrupted = {}, .deadline = std::chrono::steady_clock::now()};
  EXPECT_EQ(reciprocity(late).not_checked, "there was no time");
  EXPECT_EQ(reciprocity().not_checked, "");
}

TEST_F(LawsOfLinks, HoldWithinTheErrorOfTheirRays) {
  ASSERT_TRUE(kept_.complete);
  const LawCheck reciprocal = reciprocity(), sums = row_sums();
  EXPECT_TRUE(reciprocal.holds());
  EXPECT_TRUE(sums.holds());
  // What may be is no more than a few per cent: errors as large as those below are seen.
  EXPECT_LT(in(reciprocal, "hall").bound, 0.05);
  EXPECT_LT(in(sums, "hall").bound, 0.02);
}

TEST_F(LawsOfLinks, LightThatIsTakenFromOneSurfaceForAnotherBreaksReciprocityAndNotRowSums) {
  // The floor sees a third less of the ceiling, and more of the walls by as much.
  double moved = 0, walls = 0;
  change_links_to("floor", [&](Link& link) {
    if (is_of(link.source, "ceiling", 0)) moved += double{link.weight} / 3, link.weight *= 2.0f / 3;
    if (is_of(link.source, "walls", 0)) walls += double{link.weight};
  });
  ASSERT_GT(moved, 0);
  change_links_to("floor", [&](Link& link) {
    if (is_of(link.source, "walls", 0)) link.weight *= static_cast<float>(1 + moved / walls);
  });
  expect_broken_in_hall(reciprocity());
  EXPECT_TRUE(row_sums().holds());
}

TEST_F(LawsOfLinks, RowsThatLoseATwentiethBreakRowSums) {
  change_links_to("walls", [](Link& link) { link.weight *= 0.95f; });
  expect_broken_in_hall(row_sums());
}

class LawsOfLight : public testing::Test {
 protected:
  LawCheck energy() const {
    const Problem problem{patches_, rays_, dark_};
    return energy_of_rooms(problem, problem, solution_, 0.01, kOtherSeed);
  }
  PatchSet patches_ = two_rooms();
  RayScene rays_{patches_};
  Lights dark_;
  Solution solution_ = gauss_seidel(patches_, form_factor_matrix(patches_, rays_), Field(patches_.patch_count(), 1));
  VertexLightmap no_points_;
};

TEST_F(LawsOfLight, HoldForWhatAMethodFinds) {
  EXPECT_TRUE(no_negative_light(patches_, no_points_, solution_).holds());
  EXPECT_TRUE(radiosity_from_irradiance(patches_, solution_).holds());
  const LawCheck energy_check = energy();
  EXPECT_TRUE(energy_check.holds());
  EXPECT_TRUE(in(energy_check, "hall").resolved && in(energy_check, "store").resolved);
  EXPECT_LT(in(energy_check, "hall").bound, 0.03);
}

TEST_F(LawsOfLight, LessThanNoLightOnOnePatchIsSeen) {
  solution_.E.at(0, 0) = -2e-4 * *std::ranges::max_element(solution_.E.value);
  expect_broken_in_hall(no_negative_light(patches_, no_points_, solution_));
  solution_.E.at(0, 0) = std::numeric_limits<double>::quiet_NaN();
  expect_broken_in_hall(no_negative_light(patches_, no_points_, solution_));
}

TEST_F(LawsOfLight, LessThanNoLightAtOnePointIsSeen) {
  no_points_.patch_of_point = {0, static_cast<std::uint32_t>(patches_.patch_count() - 1)};
  no_points_.E = Field(2, 1);
  no_points_.E.value = {-0.1, 5};
  expect_broken_in_hall(no_negative_light(patches_, no_points_, solution_));
}

TEST_F(LawsOfLight, APatchThatSendsWhatItDoesNotHaveIsSeen) {
  solution_.B.at(0, 0) *= 1 + 1e-6;
  expect_broken_in_hall(radiosity_from_irradiance(patches_, solution_));
}

TEST_F(LawsOfLight, ARoomWithAFewPerCentTooMuchLightIsSeenThoughAllInAllNoneIsMissing) {
  // The rest of the bound is what rays leave open; the solution is consistent but for its balance.
  for (std::size_t i = 0; i < patches_.patch_count(); ++i) {
    if (patches_.room[i] != 0) continue;
    solution_.E.at(i, 0) *= 1.1;
    solution_.B.at(i, 0) = patches_.M.at(i, 0) + patches_.rho.at(i, 0) * solution_.E.at(i, 0);
  }
  EXPECT_TRUE(radiosity_from_irradiance(patches_, solution_).holds());
  expect_broken_in_hall(energy());
}

TEST_F(LawsOfLight, LightThatIsNowhereBreaksTheEnergyOfTheWholeScene) {
  solution_.energy.absorbed *= 0.98;
  const LawCheck check = energy();
  EXPECT_FALSE(in(check, "whole scene").holds());
  EXPECT_TRUE(in(check, "hall").holds());
}

TEST_F(LawsOfLight, ADarkRoomHasNoEnergyToCheckAndALitOneThatShouldBeDarkIsSeen) {
  for (std::size_t i = 0; i < patches_.patch_count(); ++i)
    if (patches_.room[i] == 1) patches_.M.at(i, 0) = solution_.E.at(i, 0) = solution_.B.at(i, 0) = 0;
  EXPECT_EQ(std::ranges::count(energy().rooms, "store", &LawInRoom::room), 0);
  solution_.E.at(patches_.patch_count() - 1, 0) = 1;
  EXPECT_FALSE(in(energy(), "store").holds());
}

TEST(LawsOfLightInGlass, WhatPanesTurnBackBalances) {
  // A room whose walls are of dark glass: a seventh of what leaves its surfaces comes back from these.
  PatchBuilder b(0.5);
  b.material(0.5, 50).rectangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 6, 6);
  b.material(0.5).rectangle({0, 0, 3}, {0, 4, 0}, {4, 0, 0}, 6, 6);
  b.glass(0.3).rectangle({0, 0, 0}, {0, 4, 0}, {0, 0, 3}).rectangle({4, 0, 0}, {0, 0, 3}, {0, 4, 0});
  b.rectangle({0, 0, 0}, {0, 0, 3}, {4, 0, 0}).rectangle({0, 4, 0}, {4, 0, 0}, {0, 0, 3});
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  const Lights dark;
  const Problem problem{patches, rays, dark};
  const Solution solution = solve_on_patches(problem, {.method = Method::gauss_seidel});
  const LawCheck check = energy_of_rooms(problem, problem, solution, 0.005, kOtherSeed);
  for (const LawInRoom& room : check.rooms)
    EXPECT_TRUE(room.holds()) << room.room << ": " << room.worst << " of " << room.bound;
  EXPECT_LT(check.rooms.front().bound, 0.02);
}

}  // namespace
}  // namespace clerestory
