// Sensors of every kind through the whole program, against closed forms, and what is told of them.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/csv_rows.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;
constexpr double kPi = std::numbers::pi;

/// A black plane at z = 0 that gives nothing back: only direct light counts.
class Sensors : public testing::Test {
 protected:
  Sensors() {
    folder_.write("plane.obj", "o plane\nusemtl ground\nv -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3 4\n");
  }

  /// Solves with these members of the root object; leaves the rows and the report.
  void solve(const std::string& members, std::vector<std::string> options = {}) {
    const std::string scene = folder_.write("s.json", R"({ "geometry": [{ "file": "plane.obj" }],
        "materials": { "ground": { "reflectance": 0 } }, )" +
                                                          members + " }");
    options.insert(options.begin(), {"solve", scene, "-o", folder_ / "out.vtp", "--sensors-out", folder_ / "out.csv",
                                     "--report", folder_ / "report.json", "--max-element", "9"});
    run_ = run_program(options);
    ASSERT_EQ(run_.exit_code, 0) << run_.err;
    rows_ = test::csv_rows(folder_ / "out.csv");
    report_ = Json::parse(read_text(folder_ / "report.json"));
  }
  double value(std::size_t row, const std::string& column = "illuminance") const {
    return std::stod(rows_.at(row).at(column));
  }
  static double luminous_intensity(double flux_lm) { return flux_lm / (4 * kPi); }

  TempFolder folder_;
  ProgramRun run_;
  std::vector<test::CsvRow> rows_;
  Json report_;
};

constexpr const char* kLamp = R"("luminaires": [{ "type": "point", "position": [0, 0, 3], "luminous_flux": 10000 }])";

TEST_F(Sensors, ACylinderBesideAPointLampGetsIntensityTimesSineOverPiRSquared) {
  // The mean of I cos(phi) sin(theta) / r^2 over the half of all directions that face the lamp, and 0 over the others.
  const std::string points = "2,0,1,0,0,1\n1.2,1.7,0.5,0,0,1\n-3,0.4,2.8,0,0,5\n0,2,1,0,1,0\n";
  folder_.write("points.csv", points);
  solve(kLamp + std::string(R"(, "sensors": [{ "file": "points.csv", "kind": "cylindrical" }])"));
  ASSERT_EQ(rows_.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = value(i, "x"), y = value(i, "y"), z = value(i, "z") - 3;
    const double r2 = x * x + y * y + z * z;
    const double along = x * value(i, "nx") + y * value(i, "ny") + z * value(i, "nz");  // the last one lies, along y
    const double sine = std::sqrt(1 - along * along / r2);
    const double exact = luminous_intensity(10'000) * sine / (kPi * r2);
    EXPECT_NEAR(value(i), exact, 0.0019 * exact) << i;  // of 21 planes, see sensor_planes.h
  }
  EXPECT_EQ(value(3, "ny"), 1);
}

TEST_F(Sensors, ACylinderUnderAnOpenSkyGetsWhatVerticalPlanesGet) {
  // Uniform: 1/pi * L * 2 pi * integral of sin^2(theta) from 0 to pi/2 = L pi / 2, of pi L on open ground. CIE
  // overcast, L_z (1 + 2 cos(theta)) / 3: 2 L_z / 3 (pi / 4 + 2 / 3) of 7 pi / 9 L_z. Tolerance: 256 rays a plane in 8
  // x 8 cells.
  const std::string sensors = R"(, "sensors": [{ "kind": "cylindrical", "origin": [0, 0, 1], "u": [1, 0, 0],
      "v": [0, 1, 0], "spacing": 1 }])";
  solve(R"("sky": { "model": "uniform", "horizontal_illuminance": 10000, "ground_reflectance": 0 })" + sensors);
  ASSERT_EQ(rows_.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(value(i), 5000, 25) << i;
  solve(R"("sky": { "model": "cie-overcast", "horizontal_illuminance": 10000, "ground_reflectance": 0 })" + sensors);
  const double share = 2.0 / 3 * (kPi / 4 + 2.0 / 3) / (7 * kPi / 9);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(value(i), 10'000 * share, 25) << i;
}

TEST_F(Sensors, OfACameraFaceIt) {
  // The lamp hangs at the camera: light arrives at right angles, I / r^2.
  solve(kLamp + std::string(R"(, "sensors": [{ "kind": "camera", "camera": [0, 0, 3], "origin": [-2, -2, 1],
      "u": [4, 0, 0], "v": [0, 4, 0], "spacing": 2 }])"));
  ASSERT_EQ(rows_.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    const double x = value(i, "x"), y = value(i, "y"), r2 = x * x + y * y + 4;
    EXPECT_NEAR(value(i), luminous_intensity(10'000) / r2, 1e-4 * value(i));
    EXPECT_NEAR(value(i, "nx"), -x / std::sqrt(r2), 1e-12);
    EXPECT_NEAR(value(i, "ny"), -y / std::sqrt(r2), 1e-12);
    EXPECT_NEAR(value(i, "nz"), 2 / std::sqrt(r2), 1e-12);
  }
}

TEST_F(Sensors, HorizontalOnesFaceUpWhateverTheFileSays) {
  folder_.write("points.csv", "1,0,1,0,0,-1\n");
  solve(kLamp + std::string(R"(, "sensors": [{ "file": "points.csv", "kind": "horizontal" }])"));
  ASSERT_EQ(rows_.size(), 1u);
  const double exact = luminous_intensity(10'000) * 2 / std::pow(5.0, 1.5);
  EXPECT_NEAR(value(0), exact, 1e-4 * exact);
  EXPECT_EQ(value(0, "nz"), 1);
}

TEST_F(Sensors, AreSummedUpSetBySetInTheReportAndOnStandardOutput) {
  solve(R"("sky": { "model": "uniform", "horizontal_illuminance": 100, "ground_reflectance": 0 }, )" +
        std::string(kLamp) + R"(, "sensors": [
      { "name": "desk", "origin": [0, 0, 1], "u": [3, 0, 0], "v": [0, 0.1, 0], "spacing": 1, "threshold": 150 },
      { "name": "faces", "kind": "cylindrical", "origin": [1, 0, 1], "u": [1, 0, 0], "v": [0, 0.1, 0], "spacing": 1 }])");
  ASSERT_EQ(rows_.size(), 6u);
  ASSERT_EQ(report_.at("sensors").size(), 2u);
  EXPECT_EQ(report_.at("counts").at("sensors"), 6);
  const Json& desk = report_["sensors"][0];
  EXPECT_EQ(desk.at("name"), "desk");
  EXPECT_EQ(desk.at("kind"), "planar");
  EXPECT_EQ(desk.at("points"), 4);
  // Along the row it gets darker: 299, 242, 188 and 142 lx of lamp and sky.
  const double mean = (value(0) + value(1) + value(2) + value(3)) / 4;
  EXPECT_NEAR(desk.at("mean").get<double>(), mean, 1e-9 * mean);
  EXPECT_EQ(desk.at("max"), value(0));
  EXPECT_EQ(desk.at("min"), value(3));
  EXPECT_NEAR(desk.at("median").get<double>(), (value(1) + value(2)) / 2, 1e-9 * mean);
  EXPECT_NEAR(desk.at("uniformity").get<double>(), value(3) / mean, 1e-12);
  EXPECT_EQ(desk.at("threshold"), 150);
  EXPECT_EQ(desk.at("share_above_threshold"), std::count_if(rows_.begin(), rows_.begin() + 4, [](const auto& row) {
                                                return std::stod(row.at("illuminance")) >= 150;
                                              }) / 4.0);
  EXPECT_NEAR(desk.at("daylight_factor").at("mean").get<double>(), mean, 1e-9 * mean) << "100 lx are 100 %";
  EXPECT_EQ(desk.at("daylight_factor").at("share_above_2"), 1);
  const Json& faces = report_["sensors"][1];
  EXPECT_EQ(faces.at("kind"), "cylindrical");
  EXPECT_EQ(faces.at("points"), 2);
  EXPECT_FALSE(faces.contains("threshold"));
  EXPECT_NEAR(faces.at("mean").get<double>(), (value(4) + value(5)) / 2, 1e-9 * mean);

  for (const char* words : {"lux at sensors", "  desk ", "lx or more; daylight factor", "  faces (cylindrical) "})
    EXPECT_NE(run_.out.find(words), std::string::npos) << run_.out;
  solve(std::string(kLamp) + R"(, "sensors": [{ "origin": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0], "spacing": 1 }])",
        {"--quiet"});
  EXPECT_EQ(run_.out, "");
  EXPECT_FALSE(report_["sensors"][0].contains("daylight_factor"));
}

TEST_F(Sensors, OfTheCommandLineAreOneSetNamedAfterTheirFile) {
  const std::string file = folder_.write("my points.csv", "0,0,1,0,0,1\n1,0,1,0,0,1\n");
  solve(kLamp, {"--sensors", file});
  ASSERT_EQ(report_.at("sensors").size(), 1u);
  EXPECT_EQ(report_["sensors"][0].at("name"), "my points");
  EXPECT_EQ(report_["sensors"][0].at("points"), 2);
  EXPECT_NE(run_.out.find("my points"), std::string::npos) << run_.out;
}

TEST_F(Sensors, InTheDarkHaveAUniformityOfZero) {
  // They look down on a plane that reflects nothing.
  solve(std::string(kLamp) + R"(, "sensors": [{ "origin": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0], "spacing": 1,
      "normal": [0, 0, -1], "threshold": 1 }])");
  const Json& dark = report_.at("sensors").at(0);
  EXPECT_EQ(dark.at("mean"), 0);
  EXPECT_EQ(dark.at("uniformity"), 0);
  EXPECT_EQ(dark.at("share_above_threshold"), 0);
}

TEST_F(Sensors, ACylinderInsideASolidIsNamedByItsRow) {
  folder_.write("plane.obj", read_text(folder_ / "plane.obj") +
                                 "v 0 0 0.2\nv 1 0 0.2\nv 0 1 0.2\nv 1 1 0.2\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
                                 "f 5 7 8 6\nf 9 10 12 11\nf 5 6 10 9\nf 7 11 12 8\nf 5 9 11 7\nf 6 8 12 10\n");
  folder_.write("points.csv", "2,2,1,0,0,1\n0.5,0.5,0.6,0,0,1\n");
  solve(std::string(kLamp) + R"(, "sensors": [{ "file": "points.csv", "kind": "cylindrical" }])");
  EXPECT_NE(run_.err.find("1 sensor (row 2) inside a solid"), std::string::npos) << run_.err;
}

TEST_F(Sensors, TheReportTellsTheLuminairesFluxes) {
  solve(R"("luminaires": [
      { "type": "point", "position": [0, 0, 3], "luminous_flux": 1000, "dimming": 0.5, "group": "desk" },
      { "type": "point", "position": [1, 0, 3], "luminous_flux": 300, "group": "desk" },
      { "type": "point", "position": [2, 0, 3], "luminous_flux": 700 }],
      "sensors": [{ "origin": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0], "spacing": 1 }])");
  const Json& rows = report_.at("luminaires");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].at("type"), "point");
  EXPECT_EQ(rows[0].at("group"), "desk");
  EXPECT_EQ(rows[0].at("count"), 2);
  EXPECT_NEAR(rows[0].at("luminous_flux").get<double>(), 800, 1e-9);
  EXPECT_FALSE(rows[1].contains("group"));
  EXPECT_NEAR(rows[1].at("luminous_flux").get<double>(), 700, 1e-9);
}

}  // namespace
}  // namespace clerestory
