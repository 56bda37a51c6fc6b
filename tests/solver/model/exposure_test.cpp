#include "solver/model/exposure.h"

#include <cmath>

#include <gtest/gtest.h>

#include "solver/model/inner_rooms.h"
#include "solver/model/patch_set.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

/// A square of 1 m2 of `lux` in each room.
WrittenResult squares(const std::vector<std::string>& rooms, const std::vector<float>& lux) {
  WrittenResult r;
  r.rooms = rooms;
  for (std::uint32_t k = 0; k < rooms.size(); ++k) {
    const double x = 2.0 * k;
    r.points.insert(r.points.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}});
    r.triangles.push_back({4 * k, 4 * k + 1, 4 * k + 2});
    r.triangles.push_back({4 * k, 4 * k + 2, 4 * k + 3});
    r.room.insert(r.room.end(), 2, k);
    r.of_points["illuminance"].value.insert(r.of_points["illuminance"].value.end(), 4, lux[k]);
  }
  return r;
}

TEST(ExposureOf, ShowsTheMiddleOfTheRoomsAsTheSameGreyWhateverIsOutdoors) {
  const double expected = kMiddleLight * kWhiteEfficacy / 200;  // 200 lx: the geometric mean of 100 and 400
  EXPECT_NEAR(exposure_of(squares({kOutdoors, "a", "b"}, {20'000, 100, 400}), 0), expected, 1e-6 * expected);
  EXPECT_NEAR(exposure_of(squares({kOutdoors, "a", "b"}, {20'000, 100, 400}), 2), 4 * expected, 4e-6 * expected);
}

TEST(ExposureOf, LeavesRoomsBelowWhiteWhereCorridorsAreDark) {
  // The geometric mean of 10, 10, 1000 and 1000 lx is 100: as it wants it, half of the rooms were ten times white.
  const double expected = 0.8 * kWhiteEfficacy / 1000;
  EXPECT_NEAR(exposure_of(squares({"a", "b", "c", "d"}, {10, 1000, 10, 1000}), 0), expected, 1e-6 * expected);
}

TEST(ExposureOf, TakesTheOutdoorsWhereNoRoomIsLit) {
  const double expected = kMiddleLight * kWhiteEfficacy / 20'000;
  EXPECT_NEAR(exposure_of(squares({kOutdoors, "dark"}, {20'000, 0}), 0), expected, 1e-6 * expected);
  EXPECT_EQ(exposure_of(squares({kOutdoors}, {0}), 0), 1);
}

TEST(InnerRooms, AreThoseThatPeopleUse) {
  WrittenResult r = squares({kOutdoors, "R301 Roof", "A101", "room 1", kSmallerSpaces}, {10'000, 8'700, 400, 2, 0});
  EXPECT_EQ(inner_rooms(r), (std::vector<bool>{false, true, true, false, false}))
      << "who knows how bright it is outside";
  r.around.daylight_reference = 10'000;
  EXPECT_EQ(inner_rooms(r), (std::vector<bool>{false, false, true, false, false}));
  EXPECT_EQ(inner_rooms(squares({kOutdoors, "room 1", "room 2", kSmallerSpaces}, {1, 1, 1, 1})),
            (std::vector<bool>{false, true, true, false}));
  EXPECT_EQ(inner_rooms(squares({kOutdoors, kSmallerSpaces}, {1, 1})), (std::vector<bool>{false, true}));
}

TEST(SrgbByte, IsTheStandardsCurveClipped) {
  EXPECT_EQ(srgb_byte(-1), 0);
  EXPECT_EQ(srgb_byte(0.18), 118);  // 0.4613 of white
  EXPECT_EQ(srgb_byte(1), 255);
  EXPECT_EQ(srgb_byte(7), 255);
  EXPECT_NEAR(srgb_encoded(0.0031308), 0.04045, 1e-5) << "both parts of the curve meet";
}

TEST(SkyTable, IsLinearBetweenCellsAndKeepsTheHorizonSharp) {
  SkyTable sky;
  sky.radiance = Field(SkyTable::kRows * SkyTable::kColumns, 1);
  for (std::size_t i = 0; i < sky.radiance.size(); ++i) {
    const Vec3 d = SkyTable::direction(i / SkyTable::kColumns, i % SkyTable::kColumns);
    sky.radiance.set(i, Spectrum(d.z < 0 ? 5 : 10 + d.x + d.z));
  }
  EXPECT_EQ(sky({0.6, 0.8, -1e-9})[0], 5);
  for (const Vec3& d : {Vec3{0.6, 0.8, 0.03}, Vec3{1, -1e-6, 0.5}, Vec3{-1, 1e-6, 0.5}, Vec3{0.1, -0.3, 0.9}}) {
    const Vec3 u = normalized(d);
    EXPECT_NEAR(sky(u)[0], 10 + u.x + u.z, 0.03) << u.z;  // cells of 3 degrees: half a cell at the horizon
  }
  EXPECT_TRUE(std::isfinite(sky({0, 0, 1})[0]) && std::isfinite(sky({0, 0, -1})[0]));
  EXPECT_TRUE(SkyTable().operator()({0, 0, 1}).is_black());
}

}  // namespace
}  // namespace clerestory
