#include "solver/dimming/dim_to_target.h"

#include <gtest/gtest.h>

#include "solver/dimming/linear_programme.h"

namespace clerestory {
namespace {

using Outcome = DimLevels::Outcome;

constexpr double kTolerance = 1e-6;  // Clp holds conditions to 1e-7 of the target

TEST(LinearProgramme, FindsTheCornerThatIsKnown) {
  // Least 2 x + 3 y with x + y >= 4, x <= 3: x = 3, y = 1.
  const auto x = least_cost({.cost = {2, 3}, .upper = {3, 10}, .A = {1, 1}, .at_least = {4}});
  ASSERT_TRUE(x);
  EXPECT_NEAR((*x)[0], 3, kTolerance);
  EXPECT_NEAR((*x)[1], 1, kTolerance);
}

TEST(LinearProgramme, TellsThatThereIsNoSolution) {
  EXPECT_FALSE(least_cost({.cost = {1, 1}, .upper = {1, 1}, .A = {1, 1}, .at_least = {2.01}}));
  EXPECT_FALSE(least_cost({.cost = {1}, .upper = {1}, .A = {1, -1}, .at_least = {0.5, -0.4}}));
}

TEST(DimToTarget, OneLampIsDimmedInProportion) {
  const std::vector<DimTarget> targets = {{.lux = 500, .given = {0, 0}, .of_layer = {{800, 1200}}}};
  const DimLevels found = dim_to_target(std::vector{3000.0}, targets);
  EXPECT_EQ(found.outcome, Outcome::reached);
  EXPECT_NEAR(found.level[0], 0.5, kTolerance);
}

TEST(DimToTarget, TheLampThatLightsMoreAnLumenComesFirst) {
  // A: 400 lx of 2000 lm, 0.2 a lumen; B: 300 lx of 1000 lm, 0.3. B is full, and A gives the 200 lx left over.
  const std::vector<DimTarget> targets = {{.lux = 500, .given = {0}, .of_layer = {{400}, {300}}}};
  const DimLevels found = dim_to_target(std::vector{2000.0, 1000.0}, targets);
  EXPECT_NEAR(found.level[0], 0.5, kTolerance);
  EXPECT_NEAR(found.level[1], 1, kTolerance);
}

TEST(DimToTarget, LightThatIsGivenIsNotPaidForAgain) {
  const std::vector<DimTarget> targets = {{.lux = 500, .given = {100, 300}, .of_layer = {{600, 600}}}};
  EXPECT_NEAR(dim_to_target(std::vector{1.0}, targets).level[0], 0.5, kTolerance);
}

TEST(DimToTarget, EnoughLightAlreadyLeavesAllLampsOff) {
  const std::vector<DimTarget> targets = {{.lux = 500, .given = {700}, .of_layer = {{100}, {100}}}};
  const DimLevels found = dim_to_target(std::vector{1.0, 2.0}, targets);
  EXPECT_EQ(found.outcome, Outcome::reached);
  EXPECT_EQ(found.level, std::vector({0.0, 0.0}));
}

TEST(DimToTarget, UniformityIsBoughtWithTheLampThatServesTheDarkEnd) {
  // Two points; A lights the first, B, dearer, the second. Mean 300 alone: A at 1 and B off, uniformity 0. With least
  // >= 0.5 mean, x + y >= 600 and y >= (x + y) / 4: x = 450, y = 150.
  const std::vector<double> flux = {1000, 1500};
  const std::vector<DimTarget> targets = {{.lux = 300, .given = {0, 0}, .of_layer = {{600, 0}, {0, 600}}}};
  const DimLevels uneven = dim_to_target(flux, targets);
  EXPECT_NEAR(uneven.level[0], 1, kTolerance);
  EXPECT_EQ(uneven.level[1], 0);
  const DimLevels even = dim_to_target(flux, targets, 0.5);
  EXPECT_EQ(even.outcome, Outcome::reached);
  EXPECT_NEAR(even.level[0], 0.75, kTolerance);
  EXPECT_NEAR(even.level[1], 0.25, kTolerance);
}

TEST(DimToTarget, TheLeastSensorCanBeTheTarget) {
  // The point at the far end has 40 lx of A and 160 of B; B has more of it a lumen.
  const std::vector<DimTarget> targets = {
      {.lux = 80, .of_minimum = true, .given = {0, 0}, .of_layer = {{200, 40}, {160, 160}}}};
  const DimLevels found = dim_to_target(std::vector{1000.0, 1000.0}, targets);
  EXPECT_EQ(found.level[0], 0);
  EXPECT_NEAR(found.level[1], 0.5, kTolerance);
}

TEST(DimToTarget, SeveralGridsAreServedTogether) {
  // The desk has 500 lx of its own lamp and 250 of the ceiling; the floor has the ceiling's 200 only and asks for 100.
  const std::vector<DimTarget> targets = {{.lux = 500, .given = {0}, .of_layer = {{250}, {500}}},
                                          {.lux = 100, .given = {0}, .of_layer = {{200}, {0}}}};
  const DimLevels found = dim_to_target(std::vector{8000.0, 500.0}, targets);
  EXPECT_NEAR(found.level[0], 0.5, kTolerance);
  EXPECT_NEAR(found.level[1], 0.75, kTolerance);
}

TEST(DimToTarget, ALayerThatAddsNothingStaysOff) {
  const std::vector<DimTarget> targets = {{.lux = 50, .given = {0}, .of_layer = {{100}, {0}, {0}}}};
  const DimLevels found = dim_to_target(std::vector{1000.0, 10.0, 0.0}, targets);  // the last gives no light at all
  EXPECT_NEAR(found.level[0], 0.5, kTolerance);
  EXPECT_EQ(found.level[1], 0);
  EXPECT_EQ(found.level[2], 0);
}

TEST(DimToTarget, LampsWithoutFluxCostNothing) {
  const std::vector<DimTarget> targets = {{.lux = 50, .given = {0}, .of_layer = {{0}}}};
  EXPECT_EQ(dim_to_target(std::vector{0.0}, targets).outcome, Outcome::too_dark);
}

TEST(DimToTarget, AllLampsInFullAreToldWhereTheyAreNotEnough) {
  const std::vector<DimTarget> targets = {{.lux = 500, .given = {12}, .of_layer = {{200}, {200}}}};
  const std::vector<double> flux = {1000, 1000};
  const DimLevels found = dim_to_target(flux, targets);
  EXPECT_EQ(found.outcome, Outcome::too_dark);
  EXPECT_EQ(light_at(targets[0], found.level), 412);
  EXPECT_EQ(dim_to_target(flux, targets, {}, 1.5).outcome, Outcome::reached);
}

TEST(DimToTarget, TheBestUniformityIsToldWhereItIsNotEnough) {
  // A lights the points 3 : 1, B 2 : 1, so that B alone is best: least over mean 2/3. For 300 lx it has to be on in
  // full.
  const std::vector<DimTarget> targets = {{.lux = 300, .given = {0, 0}, .of_layer = {{900, 300}, {400, 200}}}};
  const DimLevels found = dim_to_target(std::vector{1000.0, 1000.0}, targets, 0.7);
  EXPECT_EQ(found.outcome, Outcome::too_uneven);
  EXPECT_NEAR(found.best_uniformity, 2.0 / 3, 1e-4);  // where its halving ends
  EXPECT_NEAR(found.level[0], 0, 1e-3);
  EXPECT_NEAR(found.level[1], 1, 1e-3);
}

TEST(DimToTarget, TheLeastTargetUnderTheBrightestLampIsReached) {
  // A level of 1e-7 of the first lamp, which is as small as what Clp may be off by.
  const std::vector<DimTarget> targets = {{.lux = kLeastTarget, .given = {0}, .of_layer = {{1e5}, {1}}}};
  const DimLevels found = dim_to_target(std::vector{1e6, 1000.0}, targets);
  EXPECT_EQ(found.outcome, Outcome::reached);
  EXPECT_GE(light_at(targets[0], found.level), kLeastTarget * (1 - kTolerance));
}

TEST(DimToTarget, TenThousandSensorsOfTwentyLayersAreNoLongWait) {
  // Layer k has its spot at k; the answer obeys what was asked for.
  std::vector<DimTarget> targets = {{.lux = 300, .given = std::vector(10'000, 20.0), .of_layer = {}}};
  std::vector<double> flux;
  for (int k = 0; k < 20; ++k) {
    std::vector<double>& lux = targets[0].of_layer.emplace_back();
    for (int s = 0; s < 10'000; ++s) lux.push_back(40'000.0 / (50 + (s / 500.0 - k) * (s / 500.0 - k)));
    flux.push_back(1000 + 10 * k);
  }
  const DimLevels found = dim_to_target(flux, targets, 0.8);
  ASSERT_EQ(found.outcome, Outcome::reached);
  const double mean = light_at(targets[0], found.level);
  EXPECT_GE(mean, 300 * (1 - kTolerance));
  targets[0].of_minimum = true;
  EXPECT_GE(light_at(targets[0], found.level), 0.8 * mean - 300 * kTolerance);
}

}  // namespace
}  // namespace clerestory
