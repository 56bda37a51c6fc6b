// Skies, sun and weather through the whole program.

#include <numbers>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"

namespace clerestory {
namespace {

constexpr const char* kPlane = "o plane\nusemtl ground\nv 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n";

/// Illuminance [lx] at a point over an open plane, under the sky and sun of `members`.
double open_illuminance(const std::string& members, const TempFolder& folder = {}) {
  folder.write("plane.obj", kPlane);
  const std::string scene = folder.write("s.json", R"({ "geometry": [{ "file": "plane.obj" }],
      "materials": { "ground": { "reflectance": 0.2 } },
      "sensors": [{ "origin": [5, 5, 0.5], "u": [1, 0, 0], "v": [0, 1, 0], "spacing": 10, "normal": [0, 0, 1] }], )" +
                                                       members + " }");
  const ProgramRun run = run_program(
      {"solve", scene, "-o", folder / "out.vtp", "--sensors-out", folder / "out.csv", "--max-element", "10"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::istringstream rows(read_text(folder / "out.csv"));
  std::string row;
  while (std::getline(rows, row) && row.find("nx") != row.npos) {
  }
  for (int column = 0; column < 6; ++column) row = row.substr(row.find(',') + 1);
  return std::stod(row);
}

TEST(Daylight, EverySkyModelGivesAnOpenPlaneItsHorizontalIlluminance) {
  const std::string sun = R"(, "sun": { "direction": [0.3, -0.5, 0.8], "normal_illuminance": 0 })";
  for (const char* sky :
       {R"("uniform")", R"("cie-overcast")", R"("cie-clear")", R"("cie-general", "type": 2)",
        R"("cie-general", "type": 5)", R"("cie-general", "type": 12)", R"("cie-general", "type": 15)"}) {
    const double lux =
        open_illuminance(R"("sky": { "model": )" + std::string(sky) + R"(, "horizontal_illuminance": 10000 })" + sun);
    EXPECT_NEAR(lux, 10000, 10) << sky;
  }
}

TEST(Daylight, PerezGivesAnOpenPlaneTheLightOfSkyAndSun) {
  // skies.csv, 850 and 90 W/m2, sun at 60 degrees, day 172, 2 cm of water. The time tells the day only.
  const std::string given = R"("sky": { "model": "perez", "direct_normal": 850, "diffuse_horizontal": 90 },
      "time": "2026-06-21T12:00", "sun": { "direction": [0, -0.5, 0.8660254037844386])";
  EXPECT_NEAR(open_illuminance(given + " }"), 88280.99741, 88.3);
  EXPECT_NEAR(open_illuminance(given + R"(, "normal_illuminance": 0 })"), 12062.76344, 12.1);
}

TEST(Daylight, AnImageGivesAnOpenPlaneItsLuminanceTimesPi) {
  const TempFolder folder;
  // 4 x 2 pixels of 250 / 256 * 2^10 = 1000 cd/m2 in Radiance's format, not compressed.
  std::string image = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n";
  for (int k = 0; k < 8; ++k) image += "\xfa\xfa\xfa\x8a";
  folder.write("sky.hdr", image);
  EXPECT_NEAR(open_illuminance(R"("sky": { "image": "sky.hdr" })", folder), 1000 * std::numbers::pi, 3);
}

TEST(Daylight, TheOfficeInMarchHasTheLightOfItsHour) {
  const TempFolder folder;
  const ProgramRun check = run_program({"check", shipped_scene("office_march.json")});
  ASSERT_EQ(check.exit_code, 0) << check.err;
  // Hour 12 of data/skies/spring_day.epw.
  EXPECT_NE(check.out.find("Perez sky, 17800 lx"), std::string::npos) << check.out;
  EXPECT_NE(check.out.find("75400 lx"), std::string::npos) << check.out;
  const ProgramRun run = run_program({"solve", shipped_scene("office_march.json"), "-o", folder / "out.vtp",
                                      "--accuracy", "draft", "--report", folder / "report.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto daylight = nlohmann::json::parse(read_text(folder / "report.json")).at("daylight");
  EXPECT_EQ(daylight.at("weather"), "spring_day.epw");
  EXPECT_EQ(daylight.at("date"), "03-21");
  EXPECT_EQ(daylight.at("hour"), 12);
  EXPECT_EQ(daylight.at("sun_time"), "11:30");
  // At the equinox, 48.8 N; half past eleven is 10:33 by the sun, so the sun stands some 1.45 h x 15 degrees off south:
  // sin h = cos(48.8) cos(21.8) and a little declination.
  EXPECT_NEAR(daylight.at("sun_elevation").get<double>(), 37.9, 0.6);
  EXPECT_NEAR(daylight.at("sun_azimuth").get<double>(), 152, 2);
}

TEST(Daylight, AWeatherFileCutShortEndsWithExitCodeThree) {
  const TempFolder folder;
  folder.write("plane.obj", kPlane);
  folder.write("city.epw", "LOCATION,City,-,-,made up,0,48.8,2.3,1,75\nDESIGN CONDITIONS,0\n");
  const ProgramRun run = run_program(
      {"solve", folder.write("s.json", R"({ "geometry": [{ "file": "plane.obj" }], "sky": { "weather": "city.epw" },
                                   "time": "2026-03-21T12:00" })"),
       "-o", folder / "out.vtp"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("city.epw: ends after 2 lines; the header of an EPW file has 8"), std::string::npos)
      << run.err;
}

}  // namespace
}  // namespace clerestory
