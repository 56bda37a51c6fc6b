// clerestory tradeoff: a sweep as a user runs it.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <signal.h>

#include "solver/model/method.h"
#include "tests/support/box_scene.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

using Row = std::map<std::string, std::string>;

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream in(line);
  for (std::string word; std::getline(in, word, ',');) words.push_back(word);
  return words;
}

/// By "method --accuracy level".
std::map<std::string, Row> rows_of(const std::string& file) {
  std::istringstream in(read_text(file));
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = cells(line);
  std::map<std::string, Row> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> values = cells(line);
    EXPECT_EQ(values.size(), names.size()) << line;
    Row row;
    for (std::size_t k = 0; k < std::min(values.size(), names.size()); ++k) row[names[k]] = values[k];
    rows[row["method"] + " " + row["settings"]] = row;
  }
  return rows;
}

/// A room with one luminaire, of few elements: shadows and corners are coarse, so errors are large and soon told.
std::string coarse_room(const TempFolder& folder, const std::string& solver) {
  BoxScene{}.write(folder);
  return folder.write("lit.json", R"({ "geometry": [{ "file": "room.obj" }], "materials": { "wall": { "sides": 1 } },
    "luminaires": [{ "type": "point", "position": [1, 1, 2], "luminous_flux": 800 }], "solver": {)" +
                                      solver + "} }");
}

TEST(Tradeoff, SolvesByEveryMethodAndTellsTimeMemoryAndErrorOfEach) {
  const TempFolder folder, out;
  const std::string scene = coarse_room(folder, R"("max_element": 1)");
  const ProgramRun run =
      run_program({"tradeoff", scene, "-o", out / "new/dir", "--log", out / "log", "--report", out / "r.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(out / "new/dir")) names.insert(entry.path().filename());
  EXPECT_EQ(names, (std::set<std::string>{"index.html", "tradeoff.csv", "tradeoff.png", "tradeoff.svg"}));
  EXPECT_NE(run.err.find("max_element"), std::string::npos) << "what the scene says for all runs is told";
  const auto rows = rows_of(out / "new/dir/tradeoff.csv");
  EXPECT_EQ(rows.size(), 3 * std::size(kMethodNames)) << run.err;
  for (const auto& [name, row] : rows) {
    SCOPED_TRACE(name);
    const auto number = [&](const char* column) { return std::stod(row.at(column)); };
    EXPECT_GT(number("wall_s"), 0);
    EXPECT_GT(number("cpu_s"), 0);
    // A process of ours: not less than its libraries, nor with what the sweep itself holds.
    EXPECT_GT(number("peak_bytes"), 5e6);
    EXPECT_LT(number("peak_bytes"), 4e8);
    EXPECT_GT(number("elements"), 10);
    EXPECT_GT(number("rms"), 0);
    EXPECT_LT(number("rms"), 1);
    EXPECT_GE(number("p99"), number("p95"));
    EXPECT_GE(number("p95"), number("median"));
    EXPECT_EQ(number("links") > 0, row.at("method") == "hierarchical");
  }
  // The finer mesh is nearer to the paths, by far more than either confidence.
  EXPECT_LT(std::stod(rows.at("hierarchical --accuracy fine").at("rms")),
            std::stod(rows.at("hierarchical --accuracy draft").at("rms")) / 2);
  // Both solve the same matrix, to within what they stop at.
  EXPECT_NEAR(std::stod(rows.at("jacobi --accuracy standard").at("rms")),
              std::stod(rows.at("gauss-seidel --accuracy standard").at("rms")), 0.01);
  EXPECT_NE(run.out.find("fastest for an rms in the worst room of\n  10 %: --method"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("reference: "), std::string::npos) << run.out;
  EXPECT_NE(read_text(out / "log").find("hierarchical --accuracy draft:"), std::string::npos);
  const std::string page = read_text(out / "new/dir/index.html");
  EXPECT_NE(page.find("--method"), std::string::npos);
  EXPECT_EQ(read_text(out / "new/dir/tradeoff.png").substr(1, 3), "PNG");
}

TEST(Tradeoff, LeavesOutWhatIsRefusedAndSaysWhy) {
  const TempFolder folder, out;
  BoxScene{}.write(folder);
  folder.write("mirror.obj", "v 2 1 0.5\nv 3 1 0.5\nv 3 1 1.5\nv 2 1 1.5\no sheet\nusemtl mirror\nf 1 2 3 4\n");
  const std::string scene = folder.write("mirror.json", R"({ "geometry": [{ "file": "room.obj" },
    { "file": "mirror.obj" }], "materials": { "wall": { "sides": 1, "reflectance": 0.5 },
    "mirror": { "type": "mirror", "reflectance": 0.9 } }, "luminaires": [{ "type": "point", "position": [1, 2, 2],
    "luminous_flux": 800 }], "solver": { "max_element": 2 } })");
  const ProgramRun run = run_program({"tradeoff", scene, "-o", out / "dir"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto rows = rows_of(out / "dir/tradeoff.csv");
  const std::size_t runs = 3 * (std::size(kMethodNames) - 2);  // all but those of matrices
  EXPECT_EQ(rows.size(), runs) << run.err;
  EXPECT_TRUE(rows.contains("path --accuracy fine"));
  EXPECT_NE(run.out.find(std::to_string(runs) + " runs, 6 left out"), std::string::npos) << run.out;
  const std::string page = read_text(out / "dir/index.html");
  EXPECT_NE(page.find("gauss-seidel --accuracy draft: the scene has mirrors"), std::string::npos) << run.err;
}

TEST(Tradeoff, RefusesAFileForItsFolderAndASceneWithoutLight) {
  const TempFolder folder;
  const std::string scene = coarse_room(folder, "");
  const ProgramRun file = run_program({"tradeoff", scene, "-o", folder.write("taken", "mine")});
  EXPECT_EQ(file.exit_code, 3);
  EXPECT_NE(file.err.find("is a file; give a folder"), std::string::npos) << file.err;
  EXPECT_EQ(read_text(folder / "taken"), "mine");
  const std::string dark = folder.write("dark.json", R"({ "geometry": [{ "file": "room.obj" }] })");
  const ProgramRun unlit = run_program({"tradeoff", dark, "-o", folder / "dir"});
  EXPECT_EQ(unlit.exit_code, 3);
  EXPECT_NE(unlit.err.find("light"), std::string::npos) << unlit.err;
  EXPECT_FALSE(fs::exists(folder / "dir"));
  EXPECT_EQ(run_program({"tradeoff", scene}).exit_code, 2);
  EXPECT_EQ(run_program({"tradeoff", scene, "-o", folder / "d", "--time-limit", "0"}).exit_code, 2);
}

TEST(Tradeoff, WithoutTimeForOneRunNothingIsWritten) {
  const TempFolder folder, out;
  const ProgramRun run = run_program({"tradeoff", coarse_room(folder, ""), "-o", out / "dir", "--time-limit", "0.01"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_NE(run.err.find("nothing is written"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(out / "dir"));
}

TEST(Tradeoff, TheTimeLimitHoldsForTheReferenceToo) {
  const TempFolder folder, out;
  BoxScene{}.write(folder);
  // Closed, and next to nothing is absorbed: a path does not end.
  const std::string scene = folder.write("white.json", R"({ "geometry": [{ "file": "room.obj" }],
    "materials": { "wall": { "sides": 1, "reflectance": 0.99999 } },
    "luminaires": [{ "type": "point", "position": [1, 1, 2], "luminous_flux": 800 }] })");
  const auto start = std::chrono::steady_clock::now();
  const ProgramRun run = run_program({"tradeoff", scene, "-o", out / "dir", "--time-limit", "1"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_NE(run.err.find("nothing is written"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(out / "dir"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(Tradeoff, CtrlCEndsTheRunsAndWritesThoseThatHadEnded) {
  const TempFolder folder, out, elsewhere;
  const std::string log = elsewhere / "log";
  Program program({"tradeoff", coarse_room(folder, R"("max_element": 0.4)"), "-o", out / ".", "--log", log});
  ASSERT_TRUE(program.waits_for("hierarchical --accuracy draft: ", log));
  program.signal(SIGINT);
  const ProgramRun run = program.wait();
  EXPECT_EQ(run.exit_code, 5) << run.err;
  EXPECT_EQ(out.listing(), "index.html tradeoff.csv tradeoff.png tradeoff.svg ");
  EXPECT_TRUE(rows_of(out / "tradeoff.csv").contains("hierarchical --accuracy draft"));
}

TEST(Tradeoff, WhatAKilledSweepLeftTheNextOneRemoves) {
  const TempFolder folder, out, elsewhere;
  const std::string scene = coarse_room(folder, R"("max_element": 0.4)"), log = elsewhere / "log";
  Program program({"tradeoff", scene, "-o", out / ".", "--log", log});
  ASSERT_TRUE(program.waits_for("hierarchical --accuracy draft", log));
  program.signal(SIGKILL);
  EXPECT_EQ(program.wait().exit_code, 128 + SIGKILL);
  EXPECT_TRUE(out.listing().starts_with(".sweep-")) << out.listing();
  EXPECT_EQ(run_program({"tradeoff", scene, "-o", out / ".", "--time-limit", "15"}).exit_code, 0);
  EXPECT_EQ(out.listing().find(".sweep-"), std::string::npos) << out.listing();
}

}  // namespace
}  // namespace clerestory
