// Blinds after LM-83: least sets worked by hand, and against a search through all sets.

#include "solver/evaluate/blinds.h"

#include <algorithm>
#include <bit>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace clerestory {
namespace {

/// Sun of each group at each point [lx].
using Sun = std::vector<std::vector<float>>;

BlindsOfHour close(const Sun& sun, const std::vector<float>& steady = {}) {
  return close_blinds(std::vector<std::span<const float>>(sun.begin(), sun.end()), steady);
}

/// n points, of which those from `begin` to `end` have so much sun.
std::vector<float> lit(std::size_t n, std::size_t begin, std::size_t end, float lux) {
  std::vector<float> E(n);
  std::fill(E.begin() + static_cast<std::ptrdiff_t>(begin), E.begin() + static_cast<std::ptrdiff_t>(end), lux);
  return E;
}

TEST(Blinds, StayOpenWhileAtMostTwoPercentOfThePointsHaveSun) {
  EXPECT_EQ(close({lit(100, 0, 2, 5000)}).closed, 0u);
  EXPECT_EQ(close({lit(100, 0, 3, 5000)}).closed, 1u);
  EXPECT_EQ(close({lit(100, 0, 50, 999)}).closed, 0u);
  EXPECT_EQ(close({lit(100, 0, 50, 1000)}).closed, 1u);  // 1,000 lx or more
  EXPECT_EQ(close({lit(50, 0, 1, 5000)}).closed, 0u);    // a fiftieth is 2 %
  EXPECT_EQ(close({lit(49, 0, 1, 5000)}).closed, 1u);
  EXPECT_TRUE(close({}).complies);
}

TEST(Blinds, CloseTheFewestGroupsAndOfAsManyThoseThatLeaveTheLeastSun) {
  // 10, 40 and 3 points of 100: two groups must close whichever; without the first two 3 points are left, too many.
  EXPECT_EQ(close({lit(100, 0, 10, 5000), lit(100, 20, 60, 5000), lit(100, 90, 92, 5000)}).closed, 0b011u);
  EXPECT_EQ(close({lit(100, 0, 1, 5000), lit(100, 20, 60, 5000), lit(100, 90, 91, 5000)}).closed, 0b010u);
  // Both together lift the points above 1,000 lx: one is enough, of two alike the first.
  EXPECT_EQ(close({lit(100, 0, 50, 600), lit(100, 0, 50, 600)}).closed, 0b01u);
}

TEST(Blinds, HoursThatNeverComplyAreToldAndCloseWhatHelps) {
  // A window without blinds leaves all of its sun.
  const BlindsOfHour under_roof = close({lit(100, 0, 50, 5000)}, lit(100, 0, 50, 3000));
  EXPECT_FALSE(under_roof.complies);
  EXPECT_EQ(under_roof.closed, 0u) << "closing does not help";
  const BlindsOfHour roof = close({lit(100, 0, 50, 5000)}, lit(100, 90, 95, 3000));
  EXPECT_FALSE(roof.complies);
  EXPECT_EQ(roof.closed, 1u);

  BlindsYear year;
  for (const BlindsOfHour& hour : {under_roof, roof, BlindsOfHour{}, BlindsOfHour{1, true}}) add_hour(hour, year);
  EXPECT_EQ(year.hours_closed, 2);
  EXPECT_EQ(year.hours_not_complying, 2);
}

TEST(Blinds, AreTheLeastSetOfAll) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 50; ++trial) {
    Sun sun(6, std::vector<float>(40));
    for (auto& group : sun)
      for (float& E : group) E = random() % 5 == 0 ? static_cast<float>(random() % 2000) : 0;
    const auto left = [&](std::uint64_t set) {
      int n = 0;
      for (std::size_t p = 0; p < 40; ++p) {
        double lux = 0;
        for (std::size_t g = 0; g < 6; ++g) lux += (set >> g & 1) != 0 ? 0 : sun[g][p];
        n += lux >= 1000;
      }
      return n;
    };
    const BlindsOfHour chosen = close(sun);
    for (std::uint64_t set = 0; set < 64; ++set) {
      if (std::popcount(set) < std::popcount(chosen.closed)) {
        EXPECT_GT(left(set), chosen.complies ? 0 : left(chosen.closed)) << set;  // 2 % of 40 points is none
      }
      EXPECT_GE(left(set), chosen.complies ? 0 : left(chosen.closed)) << set;
    }
  }
}

TEST(Blinds, OfManyWindowsInARowAreTheLeastSetWhereEachPointHasItsSunThroughOne) {
  // Twenty windows of 1 to 20 points: the largest close until at most 4 of 210 are left, the windows of 1 and 2.
  Sun sun;
  for (std::size_t g = 0, begin = 0; g < 20; begin += ++g) sun.push_back(lit(210, begin, begin + g + 1, 5000));
  const BlindsOfHour hour = close(sun);
  EXPECT_TRUE(hour.complies);
  EXPECT_EQ(hour.closed, (std::uint64_t{1} << 20) - 1 - 0b011);
}

}  // namespace
}  // namespace clerestory
