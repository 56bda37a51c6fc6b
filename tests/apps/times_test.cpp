// solve --times through the whole program.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/read_result.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

/// An open plane in Golden, Colorado, with a sun of 50,000 lx under a clear sky.
std::string plane_scene(const TempFolder& folder) {
  folder.write("plane.obj", "o plane\nusemtl ground\nv 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n");
  return folder.write("s.json", R"({ "geometry": [{ "file": "plane.obj" }],
      "materials": { "ground": { "reflectance": 0.2, "sides": 1 } },
      "sky": { "model": "cie-clear", "horizontal_illuminance": 10000 }, "sun": { "normal_illuminance": 50000 },
      "location": { "latitude": 39.742476, "longitude": -105.1786, "timezone": -7 },
      "sensors": [{ "name": "ground", "origin": [5, 5, 0.5], "u": [1, 0, 0], "v": [0, 1, 0], "spacing": 10,
                    "normal": [0, 0, 1] }] })");
}

constexpr const char* kMorning = "2003-10-17T08:00/12:00/PT2H";

TEST(TimesProgram, WritesASeriesAResultATimeAndSensorsByTime) {
  const TempFolder folder;
  const ProgramRun run = run_program({"solve", plane_scene(folder), "-o", folder / "day.pvd", "--times", kMorning,
                                      "--max-element", "10", "--report", folder / "r.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("2003-10-17T08:00 to 2003-10-17T12:00, 3 times"), std::string::npos) << run.out;
  const std::string series = read_text(folder / "day.pvd");
  EXPECT_NE(series.find(R"(<DataSet timestep="10" part="0" file="day.2003-10-17T1000.vtp"/>)"), std::string::npos)
      << series;

  std::istringstream rows(read_text(folder / "day.sensors.csv"));
  std::string header, row;
  std::getline(rows, header);
  std::getline(rows, row);
  EXPECT_EQ(header,
            "x,y,z,nx,ny,nz,illuminance,irradiance_0,illuminance:2003-10-17T08:00,irradiance_0:2003-10-17T08:00,"
            "illuminance:2003-10-17T10:00,irradiance_0:2003-10-17T10:00,illuminance:2003-10-17T12:00,"
            "irradiance_0:2003-10-17T12:00");
  std::vector<double> values;
  std::istringstream cells(row);
  for (std::string cell; std::getline(cells, cell, ',');) values.push_back(std::stod(cell));
  ASSERT_EQ(values.size(), 14u);

  const auto report = nlohmann::json::parse(read_text(folder / "r.json"));
  ASSERT_EQ(report["times"].size(), 3u);
  EXPECT_EQ(report["settings"]["times"], kMorning);
  for (std::size_t t = 0; t < 3; ++t) {
    const auto& at = report["times"][t];
    const double elevation = at["daylight"]["sun_elevation"].get<double>() * 3.14159265358979 / 180;
    const double lux = 10'000 + 50'000 * std::sin(elevation);
    EXPECT_NEAR(values[8 + 2 * t], lux, 0.002 * lux);  // rays of a gather
    EXPECT_NEAR(at["sensors"][0]["mean"].get<double>(), values[8 + 2 * t], 1e-6 * lux);
    const WrittenResult result = read_result(folder / at["file"].get<std::string>());
    EXPECT_NEAR(std::ranges::max(result.of_points.at("illuminance").value), lux, 0.002 * lux);  // of the upper side
  }
}

TEST(TimesProgram, EachResultIsOneThatOtherCommandsTake) {
  const TempFolder folder;
  ASSERT_EQ(run_program({"solve", plane_scene(folder), "-o", folder / "day.pvd", "--times", kMorning, "--accuracy",
                         "draft", "--max-element", "10"})
                .exit_code,
            0);
  const std::string noon = folder / "day.2003-10-17T1200.vtp";
  EXPECT_EQ(run_program({"bake", noon, "-o", folder / "noon.ply"}).exit_code, 0);
  EXPECT_EQ(run_program({"report", noon, "-o", folder / "noon.html"}).exit_code, 0);
  EXPECT_NE(read_text(folder / "noon.html").find("2003-10-17T12:00"), std::string::npos);
  const ProgramRun of_series = run_program({"report", folder / "day.pvd", "-o", folder / "day.html"});
  EXPECT_EQ(of_series.exit_code, 3);
  EXPECT_NE(of_series.err.find("day.pvd: is a series, which names the result of each time; give a .vtp"),
            std::string::npos)
      << of_series.err;
}

TEST(TimesProgram, ALimitOfOpenFilesIsRaisedOrToldBeforeTheSolve) {
  const TempFolder folder;
  const std::string solve = "; $CLERESTORY solve " + plane_scene(folder) + " --accuracy draft --max-element 10 -o " +
                            (folder / "day.pvd") + " --times 2003-10-17T10:00/11:00/PT1M";
  const ProgramRun refused = run_by_shell("ulimit -n 64" + solve);
  EXPECT_EQ(refused.exit_code, 3) << refused.err;
  EXPECT_NE(refused.err.find("--times: 69 files are written together, and 64 may be open at once (ulimit -n)"),
            std::string::npos)
      << refused.err;
  EXPECT_EQ(run_by_shell("ulimit -S -n 64" + solve).exit_code, 0);
  EXPECT_TRUE(std::ifstream(folder / "day.2003-10-17T1100.vtp").good());
}

TEST(TimesProgram, WrongUsageAndWhatCannotBeReadIsRefused) {
  const TempFolder folder;
  const std::string scene = plane_scene(folder);
  const auto refused = [&](std::vector<std::string> more, int code, const std::string& words) {
    std::vector<std::string> arguments = {"solve", scene};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = run_program(arguments);
    EXPECT_EQ(run.exit_code, code) << run.err;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  };
  const std::string vtp = folder / "day.vtp", pvd = folder / "day.pvd";
  refused({"-o", vtp, "--times", kMorning}, 2, "write one that ends in .pvd");
  refused({"-o", pvd}, 2, "give --times, or write a .vtp");
  refused({"-o", pvd, "--times", kMorning, "--layers"}, 2, "--layers");
  refused({"-o", pvd, "--times", kMorning, "--method", "path"}, 2,
          "--times is of the hierarchical method only, and the method is path");
  refused({"-o", pvd, "--times", "noon"}, 3, "--times 'noon' is no series of times");
  refused({"-o", pvd, "--times", "2003-10-17T12:00/08:00/PT2H"}, 3, "ends before it begins");
  EXPECT_FALSE(std::ifstream(pvd).good());
}

}  // namespace
}  // namespace clerestory
