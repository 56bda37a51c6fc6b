#include "io/read_sensors.h"

#include <gtest/gtest.h>

#include "tests/io/reading.h"

namespace clerestory {
namespace {

class Sensors : public ::testing::Test {
 protected:
  SensorSet read(std::string_view csv) { return read_sensors(folder_.write("points.csv", csv)); }
  std::string refused(std::string_view csv) {
    try {
      read(csv);
      return "(it was read)";
    } catch (const InputError& error) {
      return error.what();
    }
  }
  TempFolder folder_;
};

TEST_F(Sensors, RowsKeepTheirOrderAndNormalsBecomeUnit) {
  const SensorSet set = read("1,2,3,0,0,2\n-1.5e0, 0.1 ,+3,0,-4,3\r\n");
  ASSERT_EQ(set.points.size(), 2u);
  EXPECT_EQ(set.name, "points");
  EXPECT_EQ(set.points[0].position, (Vec3{1, 2, 3}));
  EXPECT_EQ(set.points[0].normal, (Vec3{0, 0, 1}));
  EXPECT_EQ(set.points[1].position, (Vec3{-1.5, 0.1, 3}));
  EXPECT_DOUBLE_EQ(set.points[1].normal.y, -0.8);
}

TEST_F(Sensors, AHeaderMayOrderTheColumnsAndAddOthers) {
  const SensorSet set = read("\xef\xbb\xbfid,NX,ny,nz,x,y,z\n# remark\n\n7,0,0,1,4,5,6\n");
  ASSERT_EQ(set.points.size(), 1u);
  EXPECT_EQ(set.points[0].position, (Vec3{4, 5, 6}));
}

TEST_F(Sensors, BlanksTabsAndSemicolonsSeparateAsCommasDo) {
  const SensorSet commas = read("1,2,3,0,0,1\n-4,5.5,6,0,1,0\n");
  for (const char* rows :
       {"1 2 3 0 0 1\n-4  5.5 6 0   1 0 \n", "1\t2\t3\t0\t0\t1\n-4\t5.5\t6\t0\t1\t0\n", "1;2;3;0;0;1\n-4;5.5;6;0;1;0\n",
        "1,2,3,0,0,1\r-4,5.5,6,0,1,0", "1 2 3 0 0 1\r\n\r\n-4 5.5 6 0 1 0\r\n", "1, 2, 3\t0;0 1\n\t-4 5.5 , 6 ;0,1,0\n",
        "1;2;3;0;0;1\n-4;5,5;6;0;1;0\n", "1 2 3 0 0 1\n-4 5,5 6 0 1 0\n",
        "# made by hand\nx y z nx ny nz\n1 2 3 0 0 1\n-4 5.5 6 0 1 0\n",
        "x\ty\tz\tnx\tny\tnz\n1\t2\t3\t0\t0\t1\n-4 5.5 6 0 1 0\n",
        "\xef\xbb\xbfx;y;z;nx;ny;nz\n1;2;3;0;0;1\n-4;5,5;6;0;1;0\n"}) {
    const SensorSet set = read(rows);
    ASSERT_EQ(set.points.size(), 2u) << rows;
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(set.points[i].position, commas.points[i].position) << rows;
      EXPECT_EQ(set.points[i].normal, commas.points[i].normal) << rows;
    }
  }
}

TEST_F(Sensors, TextsOfOtherColumnsMayHoldBlanks) {
  const SensorSet set = read("point name,x,y,z,nx,ny,nz\nby the door,1,2,3,0,0,1\n\"desk, left\",4,5,6,0,0,1\n");
  ASSERT_EQ(set.points.size(), 2u);
  EXPECT_EQ(set.points[1].position, (Vec3{4, 5, 6}));
}

TEST_F(Sensors, OfUtf16AreRefusedWithTheWayOut) {
  for (const bool marked : {true, false}) {
    std::string utf16 = marked ? "\xfe\xff" : "";
    for (const char c : std::string("1,2,3,0,0,1\n")) utf16 += '\0', utf16 += c;
    EXPECT_EQ(refused(utf16), "points.csv: is UTF-16 text; save it as UTF-8");
  }
}

TEST_F(Sensors, MalformedRowsAreNamedByTheirNumber) {
  EXPECT_EQ(refused("x,y,z,nx,ny,nz\n1,2,3,0,0,1\n1,2,three,0,0,1\n"),
            "points.csv: row 3: z = 'three' is not a number");
  EXPECT_EQ(refused("1,2,3,0,0,1\n1,2,3\n"), "points.csv: row 2: 3 values; expected x,y,z,nx,ny,nz");
  EXPECT_EQ(refused("1 2 3\n"), "points.csv: row 1: 3 values; expected x,y,z,nx,ny,nz");
  EXPECT_EQ(refused("1,2,3,0,0,1\n1,2,3,0,0,1,7\n"), "points.csv: row 2: 7 values; expected x,y,z,nx,ny,nz");
  EXPECT_EQ(refused("id,x,y,z,nx,ny,nz\n1,2,3,0,0,1,7,8\n"),
            "points.csv: row 2: 8 values; expected the 7 of the header");
  EXPECT_EQ(read("1,2,3,0,0,1,,\n").points.size(), 1u);  // as spreadsheets write it
  EXPECT_EQ(refused("1,2,3,0,0,0\n"), "points.csv: row 1: the normal is 0,0,0; it needs a direction, 0,0,1 is up");
  EXPECT_EQ(refused("1,nan,3,0,0,1\n"), "points.csv: row 1: y = nan is outside [-1e12, 1e12]; positions are in metres");
  EXPECT_EQ(refused("1,2,3,0,0,inf\n"),
            "points.csv: row 1: nz = inf is outside [-1e12, 1e12]; give a normal of length 1");
  EXPECT_EQ(refused("x,y,z\n"), "points.csv: row 1: no column 'nx' in the header; expected x,y,z,nx,ny,nz");
  EXPECT_EQ(refused("# nothing\n"), "points.csv: has no sensor; expected rows of x,y,z,nx,ny,nz");
  EXPECT_EQ(refused(""), folder_ / "points.csv" + ": the file is empty");
}

}  // namespace
}  // namespace clerestory
