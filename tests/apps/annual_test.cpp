// Daylight of a year from the outside: what is known of open ground, blinds, and what is refused.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/formats/weather_year.h"
#include "io/read_result.h"
#include "tests/support/even_weather.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

using Words = std::vector<std::string>;

class Annual : public ::testing::Test {
 protected:
  void SetUp() override {
    folder.write("ground.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
    folder.write("ground.json",
                 R"({ "geometry": [{ "file": "ground.obj" }], "materials": { "*": { "reflectance": 0.2, "sides": 1 } },
        "sensors": [{ "name": "up", "origin": [0, 0, 0.5], "u": [0.5, 0, 0], "v": [0, 0.5, 0], "spacing": 0.5,
                      "normal": [0, 0, 1] }] })");
    folder.write("year.epw", even_weather());
  }
  ProgramRun annual(const std::string& scene, const Words& more = {}) const {
    Words words = {"annual", folder / scene, "--accuracy", "draft", "-o", folder / "year.vtp"};
    bool has_weather = false;
    for (const std::string& word : more) has_weather = has_weather || word == "--weather";
    if (!has_weather) words.insert(words.end(), {"--weather", folder / "year.epw"});
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  }
  nlohmann::json rooms_and_grids() const { return nlohmann::json::parse(read_text(folder / "year.json")); }

  TempFolder folder;
};

TEST_F(Annual, OpenGroundHasWhatTheWeatherSays) {
  const ProgramRun run = annual("ground.json", {"--threshold", "300,20000", "--honeybee", folder / "hb"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Weather weather = read_epw(folder / "year.epw");
  double sum = 0;
  int bright = 0;
  for (const DaylightHour& hour : daylight_year(weather, weather.place, 0, 0.2).hours) {
    const double lux = hour.diffuse_horizontal_lux + hour.direct_normal_lux() * hour.sun.z;
    sum += lux, bright += lux >= 20'000;
  }
  const nlohmann::json grid = rooms_and_grids()["grids"][0];
  // Nothing is in the way, so parts of the sky are seen whole: what is left is rounding of floats.
  EXPECT_NEAR(grid["mean_illuminance"].get<double>(), sum / 3650, 1e-3 * sum / 3650);
  EXPECT_EQ(grid["sDA"], 0) << "light in 1,460 of 3,650 hours is 40 %";
  EXPECT_EQ(grid["ASE"], 100);
  EXPECT_EQ(read_text(folder / "hb/metrics/da/up.da").substr(0, 6), "40.00\n");
  EXPECT_NE(run.out.find("year.sensors.csv, " + (folder / "hb")), run.out.npos) << run.out;
  const WrittenResult result = read_result(folder / "year.vtp");
  std::size_t tops = 0;
  for (std::size_t i = 0; i < result.triangles.size(); ++i) {
    const auto& [a, b, c] = result.triangles[i];
    if (cross(result.points[b] - result.points[a], result.points[c] - result.points[a]).z < 0) continue;
    ++tops;  // the other side sees the ground below the horizon
    EXPECT_FLOAT_EQ(result.of_cells.at("DA_300").value[i], 40);
    EXPECT_FLOAT_EQ(result.of_cells.at("hours_20000").value[i], static_cast<float>(bright));
    EXPECT_FLOAT_EQ(result.of_cells.at("ASE_hours").value[i], 1460);
  }
  EXPECT_GT(tops, 0u);
}

TEST_F(Annual, BlindsAreClosedInAsFewGroupsAsKeepTheSunOut) {
  // A window to the south, sun at noon all year, in two panes; the west one has no sun behind a screen in front of it.
  folder.write("room.obj",
               "usemtl wall\n"
               "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 0 0 2.5\nv 3 0 2.5\nv 3 3 2.5\nv 0 3 2.5\n"
               "v 0.5 0 1\nv 1.5 0 1\nv 2.5 0 1\nv 0.5 0 2\nv 1.5 0 2\nv 2.5 0 2\n"
               "v -9 -0.5 0\nv 1.5 -0.5 0\nv 1.5 -0.5 9\nv -9 -0.5 9\nv 1.5 0 0\nv 1.5 0 9\n"
               "f 1 2 3 4\nf 8 7 6 5\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n"
               "f 1 2 11 10 9\nf 2 6 14 11\nf 6 5 12 13 14\nf 5 1 9 12\n"
               "usemtl screen\nf 15 16 17 18\nf 16 19 20 17\n"
               "usemtl west\nf 9 10 13 12\nusemtl east\nf 10 11 14 13\n");
  const auto scene = [](const std::string& blinds) {
    return R"({ "geometry": [{ "file": "room.obj" }], "materials": {
        "west": { "type": "glass", "transmittance": 0.7)" +
           (blinds.empty() ? "" : blinds + R"("west" } )") + R"( },
        "east": { "type": "glass", "transmittance": 0.7)" +
           (blinds.empty() ? "" : blinds + R"("east" } )") + R"( },
        "*": { "reflectance": 0.5 } },
        "sensors": [{ "name": "desk", "origin": [0.25, 0.25, 0.8], "u": [2.5, 0, 0], "v": [0, 2.5, 0], "spacing": 0.5,
                      "normal": [0, 0, 1] }] })";
  };
  folder.write("open.json", scene(""));
  folder.write("blinds.json", scene(R"(, "blinds": { "transmittance": 0.02, "group": )"));
  const Words coarse{"--max-element", "1.5", "--detail", "0.1"};
  ASSERT_EQ(annual("open.json", coarse).exit_code, 0);
  const nlohmann::json open = rooms_and_grids()["grids"][0];
  ASSERT_EQ(annual("blinds.json", coarse).exit_code, 0);
  const nlohmann::json with_blinds = rooms_and_grids()["grids"][0];
  EXPECT_EQ(open["hours_blinds_closed"], 0);
  EXPECT_GT(with_blinds["hours_blinds_closed"], 1000);
  EXPECT_EQ(with_blinds["hours_not_complying"], 0) << "0.02 of 70,000 lx is no 1,000 lx";
  EXPECT_EQ(with_blinds["ASE"], open["ASE"]) << "with blinds open";
  // The west pane stays open: more is left than the 0.02 / 0.7 = 0.029 of closing both.
  const double left = with_blinds["mean_illuminance"].get<double>() / open["mean_illuminance"].get<double>();
  EXPECT_LT(left, 0.6);
  EXPECT_GT(left, 0.035);
}

TEST_F(Annual, FiguresAreTheSameWhateverElseIsAskedFor) {
  ASSERT_EQ(annual("ground.json", {"--schedule", "10-12"}).exit_code, 0);
  const std::string alone = read_text(folder / "year.json"), points = read_text(folder / "year.sensors.csv");
  ASSERT_EQ(annual("ground.json", {"--schedule", "10-12", "--hours", folder / "hours"}).exit_code, 0);
  EXPECT_EQ(read_text(folder / "year.json"), alone);
  EXPECT_EQ(read_text(folder / "year.sensors.csv"), points);
}

TEST_F(Annual, PartsAreWarnedOfAsTheWholeIs) {
  const ProgramRun whole = annual("ground.obj");
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_NE(whole.err.find("no room with a floor was found"), std::string::npos) << whole.err;
  const std::string expected = read_text(folder / "year.vtp");
  ASSERT_EQ(annual("ground.obj", {"--part", "1/1"}).exit_code, 0);
  const ProgramRun merged = run_program({"merge", folder / "year.vtp", "-o", folder / "merged.vtp"});
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_NE(merged.err.find("no room with a floor was found"), std::string::npos) << merged.err;
  EXPECT_TRUE(read_text(folder / "merged.vtp") == expected);
}

TEST_F(Annual, RefusesWhatItCannotUse) {
  const auto refused = [&](const std::string& scene, const Words& more) {
    const ProgramRun run = annual(scene, more);
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "year.vtp"));
    return run.err;
  };
  EXPECT_NE(refused("ground.json", {"--schedule", "9-9"}).find("--schedule"), std::string::npos);
  EXPECT_NE(refused("ground.json", {"--weather", folder / "none.epw"}).find("none.epw"), std::string::npos);
  EXPECT_NE(refused("ground.obj", {"--hours", folder / "hours"}).find("--hours: there are no sensors"),
            std::string::npos);
  folder.write("pane.json", R"({ "geometry": [{ "file": "ground.obj" }], "materials": {
      "*": { "type": "glass", "transmittance": 0.3, "blinds": { "transmittance": 0.5, "group": "a" } } } })");
  EXPECT_NE(refused("pane.json", {}).find("is more than the pane passes without blinds, 0.3"), std::string::npos);
  EXPECT_NE(refused("ground.json", {"--sensors-out", folder / "nowhere/s.csv"}).find("nowhere"), std::string::npos);
  EXPECT_NE(refused("ground.obj", {"--sensors-out", folder / "s.csv"}).find("there are no sensors to write"),
            std::string::npos);
  std::string every_hour;
  for (int h = 0; h < 8760; ++h) every_hour += "1\n";
  const std::string schedule = folder.write("schedule.csv", every_hour);
  EXPECT_NE(refused("ground.json", {"--schedule", schedule, "--sensors-out", schedule}).find("--schedule"),
            std::string::npos);
  EXPECT_EQ(read_text(schedule), every_hour);
}

TEST_F(Annual, WhatIsNoChoiceOrNoThresholdIsAWrongUsage) {
  const std::pair<Words, const char*> wrongs[] = {{{"--sky-parts", "146"}, "146 is not one of"},
                                                  {{"--threshold", "0"}, "'0' is no illuminance of [1, 1000000] lx"},
                                                  {{"--threshold", "300,-5"}, "'-5' is no illuminance"},
                                                  {{"--threshold", "nan"}, "'nan' is no illuminance"},
                                                  {{"--threshold", "1e-50"}, "'1e-50' is no illuminance"},
                                                  {{"--threshold", "500,300,300"}, "has 300 lx twice"},
                                                  {{"--threshold", "300,300.0000001"}, "has 300 lx twice"}};
  for (const auto& [words, message] : wrongs) {
    const ProgramRun run = annual("ground.json", words);
    EXPECT_EQ(run.exit_code, 2) << words[1];
    EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
  }
}

TEST_F(Annual, SettingsOfTheSceneThatAYearDoesNotFollowAreSaidAndLeftOut) {
  folder.write("settings.json", R"({ "geometry": [{ "file": "ground.obj" }],
      "solver": { "method": "progressive", "target_error": 0.02, "time_limit": 100, "memory_limit": "1GiB", "seed": 5 } })");
  const ProgramRun run = annual("settings.json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const WrittenResult result = read_result(folder / "year.vtp");
  EXPECT_EQ(result.texts.at("settings.method").front(), "hierarchical");
  EXPECT_EQ(result.figures.at("settings.seed"), 5);
  for (const std::string setting : {"method", "target_error", "time_limit", "memory_limit"}) {
    EXPECT_NE(run.err.find("solver." + setting), std::string::npos) << run.err;
    EXPECT_FALSE(result.figures.contains("settings." + setting));
  }
}

TEST_F(Annual, ResultIsDrawnAndNoPageTakesItForOneHour) {
  ASSERT_EQ(annual("ground.json").exit_code, 0);
  const ProgramRun picture = run_program({"render", folder / "year.vtp", "-o", folder / "DA.png", "--show", "DA_300",
                                          "--size", "64x48", "--samples", "1"});
  EXPECT_EQ(picture.exit_code, 0) << picture.err;
  const ProgramRun page = run_program({"report", folder / "year.vtp", "-o", folder / "year.html"});
  EXPECT_EQ(page.exit_code, 3) << page.err;
  EXPECT_NE(page.err.find("is a year of daylight"), std::string::npos) << page.err;
}

}  // namespace
}  // namespace clerestory
