#include "solver/model/solar_position.h"

#include <gtest/gtest.h>

#include "tests/support/sky_rows.h"

namespace clerestory {
namespace {

// Reda & Andreas 2004, worked example: Golden, Colorado, 17 October 2003, 12:30:30.
const Place kGolden{39.742476, -105.1786, -7};
const Moment kExample{2003, 10, 17, 12 + 30.5 / 60};

TEST(SolarPosition, OfTheWorkedExampleOfTheSolarPositionAlgorithm) {
  const Horizontal sun = sun_without_air(kGolden, kExample);
  const double seen = sun.elevation_deg + refraction_deg(sun.elevation_deg, 820, 11);
  std::printf("zenith angle off by %.5f degrees, azimuth by %.5f\n", 90 - seen - 50.11162, sun.azimuth_deg - 194.34024);
  EXPECT_NEAR(90 - seen, 50.11162, 0.01);
  EXPECT_NEAR(sun.azimuth_deg, 194.34024, 0.01);
  // The mean atmosphere at sea level bends by 0.004 degrees more than the air over Golden.
  EXPECT_NEAR(90 - sun_position(kGolden, kExample).elevation_deg, 50.11162, 0.01);
}

TEST(SolarPosition, IsThatOfTheReferenceRows) {
  const auto rows = test::sky_rows("solar_position");
  const Horizontal sun = sun_without_air(kGolden, kExample);
  for (const test::SkyRow& row : rows) {
    if (row.model == "Spencer" || row.quantity == "equation of time")
      continue;  // good to 0.3 degrees only; no position
    const bool with_air = row.quantity.find("with refraction") != std::string::npos;
    const double value = row.quantity.find("azimuth") != std::string::npos ? sun.azimuth_deg
                         : with_air ? 90 - sun.elevation_deg - refraction_deg(sun.elevation_deg, 820, 11)
                                    : 90 - sun.elevation_deg;
    EXPECT_NEAR(value, row.value, 0.01) << row.model << ": " << row.quantity;
  }
}

TEST(SolarPosition, StandsWhereTheSeasonsSay) {
  // Solstices and equinoxes of the almanac: declination +-23.44 and 0. On the equator at true noon the zenith distance
  // is the declination; the equation of time (-1.9, -7.4 and +2.0 minutes) moves noon.
  const Place equator{0, 0, 0};
  const auto highest = [&](int year, int month, int day) {
    double best = -90;
    for (int minute = 0; minute < 60; ++minute)
      best = std::max(best, sun_without_air(equator, {year, month, day, 11.5 + minute / 60.0}).elevation_deg);
    return best;
  };
  EXPECT_NEAR(highest(2026, 6, 21), 90 - 23.436, 0.01);
  EXPECT_NEAR(highest(2026, 12, 21), 90 - 23.436, 0.01);
  EXPECT_NEAR(highest(2026, 3, 20), 90, 0.15);
}

TEST(SolarPosition, SeesTheSunInTheNorthFromTheSouthAndBelowTheHorizonAtMidnight) {
  const Horizontal sydney = sun_position({-33.87, 151.2, 10}, {2026, 6, 21, 12});
  EXPECT_TRUE(sydney.azimuth_deg < 10 || sydney.azimuth_deg > 350) << sydney.azimuth_deg;
  EXPECT_NEAR(sydney.elevation_deg, 90 - 33.87 - 23.44, 0.1);
  EXPECT_LT(sun_position(kGolden, {2003, 10, 17, 0}).elevation_deg, -50);
  EXPECT_GT(sun_position({70, 20, 1}, {2026, 6, 21, 0}).elevation_deg, 2);  // midnight sun
}

TEST(SolarPosition, TimezoneAndLongitudeMoveTheClockAndNotTheSun) {
  const Horizontal a = sun_position({48.8, 2.3, 1}, {2026, 3, 21, 12}),
                   b = sun_position({48.8, 2.3, 0}, {2026, 3, 21, 11});
  const Horizontal c = sun_position({48.8, 2.3, 14}, {2026, 3, 22, 1});
  EXPECT_NEAR(a.azimuth_deg, b.azimuth_deg, 1e-9);
  EXPECT_NEAR(a.elevation_deg, c.elevation_deg, 1e-9);
}

TEST(Refraction, IsHalfADegreeAtTheHorizonAndNothingOverhead) {
  EXPECT_NEAR(refraction_deg(0), 0.48, 0.02);
  EXPECT_NEAR(refraction_deg(10), 0.09, 0.003);
  EXPECT_NEAR(refraction_deg(90), 0, 1e-4);
  EXPECT_EQ(refraction_deg(-2), 0);
}

TEST(SceneDirection, TurnsClockwiseFromNorth) {
  const auto expect = [](const Vec3& d, const Vec3& wanted) { EXPECT_NEAR(length(d - wanted), 0, 1e-15); };
  expect(scene_direction({0, 0}), {0, 1, 0});
  expect(scene_direction({0, 90}), {1, 0, 0});
  expect(scene_direction({90, 123}), {0, 0, 1});
  // North of the scene turned to +x: a sun in the south stands at -x.
  expect(scene_direction({0, 180}, 90), {-1, 0, 0});
}

TEST(CompassDirection, LeadsBackFromTheScene) {
  for (const double north : {0.0, 30.0, -200.0, 725.0})
    for (const Horizontal& sun : {Horizontal{10, 0}, {-5, 89}, {60, 181}, {30, 359}}) {
      const Horizontal back = compass_direction(scene_direction(sun, north), north);
      EXPECT_NEAR(back.elevation_deg, sun.elevation_deg, 1e-9);
      EXPECT_NEAR(std::remainder(back.azimuth_deg - sun.azimuth_deg, 360), 0, 1e-9) << north;
      EXPECT_GE(back.azimuth_deg, 0);
      EXPECT_LT(back.azimuth_deg, 360);
    }
  EXPECT_NEAR(compass_direction({0, 0, 1}).elevation_deg, 90, 1e-12);
}

TEST(DayOfYear, CountsLeapDays) {
  EXPECT_EQ(day_of_year({2026, 1, 1, 0}), 1);
  EXPECT_EQ(day_of_year({2026, 12, 31, 0}), 365);
  EXPECT_EQ(day_of_year({2028, 3, 1, 0}), 61);
}

}  // namespace
}  // namespace clerestory
