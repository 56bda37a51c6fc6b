#include "solver/evaluate/sensor_summary.h"

#include <gtest/gtest.h>

#include "solver/model/units.h"

namespace clerestory {
namespace {

SensorSet named(const std::string& name, std::size_t points, std::optional<double> threshold = {}) {
  return {name, std::vector<SensorPoint>(points, {{0, 0, 0}, {0, 0, 1}}), SensorKind::planar, threshold};
}

TEST(SensorSummary, HasTheFiguresOfAFieldMadeByHand) {
  const SensorSummary s = summary_of(named("desk", 4, 200), {400, 100, 300, 200}, 10'000);
  EXPECT_EQ(s.name, "desk");
  EXPECT_EQ(s.points, 4u);
  EXPECT_DOUBLE_EQ(s.mean, 250);
  EXPECT_EQ(s.min, 100);
  EXPECT_EQ(s.max, 400);
  EXPECT_DOUBLE_EQ(s.median, 250) << "halfway between the middle two";
  EXPECT_DOUBLE_EQ(s.uniformity, 0.4);
  ASSERT_TRUE(s.threshold);
  EXPECT_EQ(s.threshold->lux, 200);
  EXPECT_DOUBLE_EQ(s.threshold->share, 0.75) << "a point at the threshold counts";
  ASSERT_TRUE(s.daylight_factor);
  EXPECT_DOUBLE_EQ(s.daylight_factor->mean, 2.5);
  EXPECT_DOUBLE_EQ(s.daylight_factor->median, 2.5);
  EXPECT_DOUBLE_EQ(s.daylight_factor->share, 0.75) << "2 % of 10,000 lx are 200 lx";
}

TEST(SensorSummary, OfAnOddNumberOfPointsHasTheMiddleOneAsMedian) {
  const SensorSummary s = summary_of(named("desk", 3), {900, 10, 20}, {});
  EXPECT_EQ(s.median, 20);
  EXPECT_DOUBLE_EQ(s.mean, 310);
  EXPECT_FALSE(s.threshold);
  EXPECT_FALSE(s.daylight_factor);
}

TEST(SensorSummary, InTheDarkHasNoUniformity) {
  const SensorSummary s = summary_of(named("cellar", 2, 1), {0, 0}, 10'000);
  EXPECT_EQ(s.uniformity, 0);
  EXPECT_EQ(s.threshold->share, 0);
  EXPECT_EQ(s.daylight_factor->mean, 0);
}

TEST(SensorSummary, TakesEachSetsOwnPointsInLux) {
  Field E(3, 3);
  for (std::size_t i = 0; i < 3; ++i) E.set(i, {1.0 + double(i), 1.0 + double(i), 1.0 + double(i)});
  const SensorSet sets[] = {named("a", 1), named("b", 2)};
  const auto summaries = summaries_of(sets, E, {});
  ASSERT_EQ(summaries.size(), 2u);
  EXPECT_NEAR(summaries[0].mean, kWhiteEfficacy, 1e-9);
  EXPECT_EQ(summaries[1].name, "b");
  EXPECT_NEAR(summaries[1].min, 2 * kWhiteEfficacy, 1e-9);
  EXPECT_NEAR(summaries[1].max, 3 * kWhiteEfficacy, 1e-9);
}

}  // namespace
}  // namespace clerestory
