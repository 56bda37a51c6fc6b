// clerestory solve --layers and clerestory mix, from the outside.

#include <cmath>
#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/csv_rows.h"
#include "tests/support/result_file.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

/// Two lamps over a plane and a glowing sheet beside it, each switched by itself; the plane is black unless told.
class Mix : public testing::Test {
 protected:
  Mix() {
    folder_.write("plane.obj",
                  "o plane\nusemtl ground\nv -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3 4\n"
                  "o sheet\nusemtl glow\nv 8 -1 1\nv 8 1 1\nv 8 1 3\nv 8 -1 3\nf 5 6 7 8\n");
  }
  std::string scene(const std::string& groups = R"("left", "right", "panel")", double left = 1, double panel = 1,
                    double reflectance = 0) {
    const Json g = Json::parse("[" + groups + "]");
    const auto lamp = [&](double x, const Json& group, double dimming) {
      return Json{
          {"type", "point"}, {"position", {x, 0, 3}}, {"luminous_flux", 10000}, {"dimming", dimming}, {"group", group}};
    };
    const Json json = {
        {"geometry", {{{"file", "plane.obj"}}}},
        {"materials",
         {{"ground", {{"reflectance", reflectance}}},
          {"glow", {{"reflectance", 0}, {"luminous_exitance", 5000 * panel}, {"group", g[2]}}}}},
        {"luminaires", {lamp(-2, g[0], left), lamp(2, g[1], 1)}},
        {"sensors", {{{"name", "desk"}, {"origin", {-3, 0, 1}}, {"u", {6, 0, 0}}, {"v", {0, 1, 0}}, {"spacing", 1}}}}};
    return folder_.write("s.json", json.dump());
  }
  ProgramRun solve(const std::string& scene, const std::string& name, std::vector<std::string> options = {}) {
    options.insert(options.begin(), {"solve", scene, "-o", folder_ / (name + ".vtp"), "--max-element", "3",
                                     "--no-error", "--accuracy", "draft"});
    return run_program(options);
  }
  ProgramRun mix(const std::string& from, const std::string& to, std::vector<std::string> options) {
    options.insert(options.begin(), {"mix", folder_ / (from + ".vtp"), "-o", folder_ / (to + ".vtp")});
    return run_program(options);
  }
  std::vector<test::CsvRow> sensors(const std::string& name) {
    return test::csv_rows(folder_ / (name + ".sensors.csv"));
  }

  TempFolder folder_;
};

double value(const test::CsvRow& row, const std::string& column) { return std::stod(row.at(column)); }

TEST_F(Mix, EachLayerIsWhatItsLampGivesAloneAndTheJointResultKeepsItsBits) {
  ASSERT_EQ(solve(scene(), "joint").exit_code, 0);
  const ProgramRun run = solve(scene(), "layered", {"--layers"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const ResultFile joint = read_result(folder_ / "joint.vtp"), layered = read_result(folder_ / "layered.vtp");
  for (const auto& [name, array] : joint.of_points) EXPECT_EQ(layered.of_points.at(name).values, array.values) << name;
  for (const auto& [name, array] : joint.of_cells) EXPECT_EQ(layered.of_cells.at(name).values, array.values) << name;
  EXPECT_EQ(layered.texts.at("layer_names"), (std::vector<std::string>{"left", "right", "panel"}));
  EXPECT_NEAR(layered.numbers.at("layer_luminous_flux").values[0], 10'000, 1e-9);

  // A point lamp over a black plane: E = I cos(theta) / r^2.
  const auto rows = sensors("layered");
  ASSERT_FALSE(rows.empty());
  for (const auto& row : rows) {
    const double x = value(row, "x") + 2, y = value(row, "y"), r2 = x * x + y * y + 4;
    const double lux = 10'000 / (4 * std::numbers::pi) * 2 / std::pow(r2, 1.5);
    EXPECT_NEAR(value(row, "illuminance:left"), lux, 1e-6 * lux);
    const double sum =
        value(row, "illuminance:left") + value(row, "illuminance:right") + value(row, "illuminance:panel");
    EXPECT_NEAR(sum, value(row, "illuminance"), 1e-5 * sum);
    EXPECT_NEAR(179 * value(row, "irradiance_0:right"), value(row, "illuminance:right"), 1e-9 * sum);
  }
  for (const auto* arrays : {&layered.of_points, &layered.of_cells}) {
    const auto& all = arrays->at("irradiance").values;
    for (std::size_t i = 0; i < all.size(); ++i) {
      double sum = 0;
      for (const char* name : {"irradiance:left", "irradiance:right", "irradiance:panel"})
        sum += arrays->at(name).values[i];
      EXPECT_NEAR(sum, all[i], 1e-5 * all[i]);
    }
  }
}

TEST_F(Mix, IsTheSolveAtThoseLevels) {
  ASSERT_EQ(solve(scene(R"("left", "right", "panel")", 1, 1, 0.5), "layered", {"--layers"}).exit_code, 0);
  const ProgramRun run = mix("layered", "mixed",
                             {"--set", "left=0.25", "--set", "panel=0.5", "--sensors-out",
                              folder_ / "mixed.sensors.csv", "--report", folder_ / "mixed.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("desk"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("0.2500 times as solved"), std::string::npos) << run.out;
  ASSERT_EQ(solve(scene(R"("left", "right", "panel")", 0.25, 0.5, 0.5), "fresh", {"--report", folder_ / "fresh.json"})
                .exit_code,
            0);
  const auto mixed = sensors("mixed"), fresh = sensors("fresh");
  ASSERT_EQ(mixed.size(), fresh.size());
  for (std::size_t i = 0; i < fresh.size(); ++i)  // two solves by draft's rays, of which the panel's light hangs
    EXPECT_NEAR(value(mixed[i], "illuminance"), value(fresh[i], "illuminance"), 0.01 * value(fresh[i], "illuminance"));
  const Json a = Json::parse(read_text(folder_ / "mixed.json")), b = Json::parse(read_text(folder_ / "fresh.json"));
  for (const char* part : {"emitted", "absorbed", "escaped"})
    EXPECT_NEAR(a["energy"][part].get<double>(), b["energy"][part].get<double>(),
                0.005 * b["energy"]["emitted"].get<double>());
  EXPECT_EQ(a["layers"][0]["factor"], 0.25);
  EXPECT_EQ(a["repairs"], b["repairs"]);
  // The panel itself shines at half of its radiosity.
  const ResultFile result = read_result(folder_ / "mixed.vtp");
  double brightest = 0;
  for (const double lm : result.of_cells.at("luminance").values) brightest = std::max(brightest, lm);
  EXPECT_NEAR(brightest, 2500 / std::numbers::pi, 1e-3 * brightest);
}

TEST_F(Mix, DimsToATargetThatTheClosedFormAndAFreshSolveConfirm) {
  ASSERT_EQ(solve(scene(), "layered", {"--layers"}).exit_code, 0);
  const ProgramRun run = mix("layered", "dimmed",
                             {"--set", "right=1", "--set", "panel=0", "--target", "desk=120", "--sensors-out",
                              folder_ / "dimmed.sensors.csv", "--report", folder_ / "dimmed.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  // Both lamps lie alike to the desk, so each gives it the same mean m of E = I cos(theta) / r^2: level = (120 - m) /
  // m.
  double m = 0;
  const auto rows = sensors("layered");
  for (const auto& row : rows) {
    const double x = value(row, "x") + 2, y = value(row, "y"), r2 = x * x + y * y + 4;
    m += 10'000 / (4 * std::numbers::pi) * 2 / std::pow(r2, 1.5) / static_cast<double>(rows.size());
  }
  const Json report = Json::parse(read_text(folder_ / "dimmed.json"));
  const double level = report["layers"][0]["factor"];
  const double exact = (120 - m) / m;
  EXPECT_NEAR(level, exact, 1e-5) << run.out;
  EXPECT_NE(run.out.find("dimmed  'left'="), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("saved"), std::string::npos) << run.out;
  ASSERT_EQ(solve(scene(R"("left", "right", "panel")", level, 0), "fresh", {"--seed", "2"}).exit_code, 0);
  double mean = 0;
  for (const auto& row : sensors("fresh")) mean += value(row, "illuminance") / static_cast<double>(rows.size());
  EXPECT_NEAR(mean, 120, 1e-3);  // lux; the plane is black, so neither solve has noise
}

TEST_F(Mix, WhatItWritesIsAResultForEveryCommand) {
  ASSERT_EQ(solve(scene(), "layered", {"--layers"}).exit_code, 0);
  ASSERT_EQ(mix("layered", "mixed", {"--set", "right=0"}).exit_code, 0);
  EXPECT_EQ(mix("mixed", "again", {"--set", "left=0.5"}).exit_code, 0);
  EXPECT_EQ(run_program({"bake", folder_ / "again.vtp", "-o", folder_ / "a.ply"}).exit_code, 0);
  EXPECT_EQ(run_program({"report", folder_ / "again.vtp", "-o", folder_ / "a.html"}).exit_code, 0);
  EXPECT_EQ(run_program({"render", folder_ / "again.vtp", "-o", folder_ / "a.png", "--size", "64x48", "--show",
                         "illuminance:left"})
                .exit_code,
            0);
}

TEST_F(Mix, WhatCannotBeIsRefusedWithOneMessage) {
  const auto expect = [](const ProgramRun& run, int code, const std::string& words) {
    EXPECT_EQ(run.exit_code, code) << words;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  };
  expect(solve(scene(), "out", {"--layers", "--method", "progressive"}), 2, "--layers is of the hierarchical method");
  expect(solve(scene(R"("sun", "right", "panel")"), "out", {"--layers"}), 3,
         "'sun' is the name of the layer of the sun");
  expect(solve(scene(R"("left", "a=b", "panel")"), "out", {"--layers"}), 3, "'a=b' has one of the characters");
  EXPECT_EQ(solve(scene(R"("sun", "a=b", "panel")"), "plain").exit_code, 0) << "without layers names are free";
  expect(mix("plain", "out", {"--set", "sun=1"}), 3, "solve the scene again with --layers");
  ASSERT_EQ(solve(scene(), "layered", {"--layers"}).exit_code, 0);
  expect(mix("layered", "out", {"--set", "lift=1"}), 3, "did you mean 'left'?");
  expect(mix("layered", "out", {"--set", "left=1", "--set", "left=2"}), 2, "'left' is set twice");
  expect(mix("layered", "layered", {"--set", "left=1"}), 3, "is the input");
  for (const char* bad : {"left=-1", "left=nan", "left", "=1", "left=1001"})
    expect(mix("layered", "out", {"--set", bad}), 2, "write LAYER=FACTOR");
  expect(mix("layered", "out", {}), 2, "--set");

  expect(mix("layered", "out", {"--target", "desck=100"}), 3, "did you mean 'desk'?");
  expect(mix("layered", "out", {"--target", "desk=1e5"}), 3, "'left', 'right', 'panel' all at 1 give");
  expect(mix("layered", "out", {"--target", "desk=10", "--uniformity", "1"}), 3,
         "the best that 'left', 'right', 'panel' can");
  expect(mix("layered", "out", {"--target", "desk=10", "--set", "lift=1"}), 3, "did you mean 'left'?");
  expect(mix("plain", "out", {"--target", "desk=10"}), 3, "solve the scene again with --layers");
  for (const char* bad : {"desk=0", "desk=1e-300", "desk=nan", "desk", "=5", "desk=5:max"})
    expect(mix("layered", "out", {"--target", bad}), 2, "GRID=LUX");
  expect(mix("layered", "out", {"--target", "desk=10", "--uniformity", "1.5"}), 2, "outside (0, 1]");
  expect(mix("layered", "out", {"--target", "desk=10", "--max", "0"}), 2, "outside (0, 1000]");
  expect(mix("layered", "out", {"--commission", "--set", "left=1"}), 2, "--target");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.vtp")) << "what is refused writes nothing";
}

}  // namespace
}  // namespace clerestory
