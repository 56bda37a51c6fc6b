// Nodes around positions of the sun, at places from the south to beyond the polar circle.

#include "solver/annual/sun_nodes.h"

#include <numbers>

#include <gtest/gtest.h>

#include "solver/model/solar_position.h"

namespace clerestory {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Every hour's sun above the horizon.
std::vector<Vec3> suns_of_year(double latitude_deg, double north_deg) {
  std::vector<Vec3> suns;
  const Place place{latitude_deg, 0, 0};
  for (int month = 1; month <= 12; ++month)
    for (int day = 1; day <= 28; day += 3)
      for (int hour = 0; hour < 24; ++hour) {
        const Horizontal at = sun_position(place, {2001, month, day, hour + 0.5});
        if (at.elevation_deg > 0) suns.push_back(scene_direction(at, north_deg));
      }
  return suns;
}

class SunNodesAt : public testing::TestWithParam<double> {};

TEST_P(SunNodesAt, AnyLatitudeWeightsSumToOneAndMeetTheSun) {
  for (const double north_deg : {0.0, 130.0})
    for (const double step_deg : {12.0, 5.0}) {
      const std::vector<Vec3> suns = suns_of_year(GetParam(), north_deg);
      ASSERT_FALSE(suns.empty());
      const SunNodes nodes = place_sun_nodes(suns, GetParam(), north_deg, step_deg);
      ASSERT_EQ(nodes.of_sun.size(), suns.size());
      for (const Vec3& d : nodes.direction) {
        EXPECT_NEAR(length(d), 1, 1e-12);
        EXPECT_GE(d.z, std::sin(0.999 * kDegree)) << "light comes from above the horizon";
      }
      for (std::size_t s = 0; s < suns.size(); ++s) {
        const AmongNodes& among = nodes.of_sun[s];
        double sum = 0;
        Vec3 mean;
        bool is_lifted = false;
        for (std::size_t k = 0; k < 4; ++k) {
          EXPECT_GE(among.weight[k], 0);
          if (!(among.weight[k] > 0)) continue;
          ASSERT_LT(among.node[k], nodes.direction.size());
          const Vec3& node = nodes.direction[among.node[k]];
          sum += double{among.weight[k]}, mean += node * double{among.weight[k]};
          is_lifted |= node.z < std::sin(1.001 * kDegree);
          // No farther than over a whole cell; those that the ground hides are lifted by so much more.
          EXPECT_GE(dot(suns[s], node), std::cos((2 * step_deg + 1) * kDegree)) << s;
        }
        EXPECT_NEAR(sum, 1, 1e-6);
        // A chord lies within the circle by 1 - cos(step / 2), and nodes that were lifted pull the mean up.
        const double off = std::acos(std::min(1.0, dot(normalized(mean), suns[s]))) / kDegree;
        EXPECT_LE(off, is_lifted ? step_deg : 0.04 * step_deg) << GetParam() << " sun " << s << " z " << suns[s].z;
      }
    }
}

INSTANTIATE_TEST_SUITE_P(All, SunNodesAt, testing::Values(-35, 0, 21, 52, 70, 89));

TEST(SunNodes, ThePolarNightHasNone) {
  const SunNodes nodes = place_sun_nodes({}, 80, 0, 8);
  EXPECT_TRUE(nodes.direction.empty());
  EXPECT_TRUE(nodes.of_sun.empty());
}

}  // namespace
}  // namespace clerestory
