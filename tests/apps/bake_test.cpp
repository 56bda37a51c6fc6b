// clerestory bake from the outside: what it writes, and what it refuses.

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/support/glb_file.h"
#include "tests/support/result_file.h"
#include "tests/support/run_program.h"
#include "tests/support/solved_box.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

class Bake : public testing::Test {
 protected:
  void expect_refusal(std::vector<std::string> arguments, int exit_code, const std::string& words) {
    arguments.insert(arguments.begin(), "bake");
    const std::string before = folder_.listing();
    const ProgramRun run = run_program(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_NE(run.err.find(words), std::string::npos) << words << "\n" << run.err;
    EXPECT_EQ(folder_.listing(), before) << "nothing is written";
  }

  TempFolder folder_;
  BoxScene box_;
  std::string result_ = SolvedBox{.box = box_}.write(folder_), scene_ = folder_ / "room.json";
};

TEST_F(Bake, WritesOverNoFileOfTheSceneThatWasSolved) {
  const std::string model = folder_ / "room.obj", before = read_text(model), scene = read_text(scene_);
  expect_refusal({result_, "-o", model}, 3, "room.obj");
  expect_refusal({result_, "-o", folder_ / "a.ply", "--report", scene_}, 3, "room.json");
  const std::string exr = fs::path(scene_).replace_extension(".exr").string();
  expect_refusal({result_, "-o", exr}, 3, "room.json");  // its charts would be
  EXPECT_EQ(read_text(model), before);
  EXPECT_EQ(read_text(scene_), scene);
}

TEST_F(Bake, SaysAgainWhatTheSolveWarnedOf) {
  const std::string doubtful =
      SolvedBox{.box = box_, .warnings = {"a", "b", "c", "2 % of the light is missing"}}.write(folder_);
  for (const std::vector<std::string>& command : {std::vector<std::string>{"bake", doubtful, "-o", folder_ / "a.ply"},
                                                  {"render", doubtful, "-o", folder_ / "a.png", "--size", "32x18"}}) {
    const ProgramRun run = run_program(command);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.err.find("warning: when it was solved: 2 % of the light is missing"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("1 more warning;"), std::string::npos) << run.err;
    EXPECT_EQ(run.err.find("solved: a\n"), std::string::npos) << run.err;
  }
}

TEST_F(Bake, ALitRoomHasTheLightOfTheSolutionInEveryFormatAndDetail) {
  // Every surface receives B = M / (1 - rho), up to what a draft errs.
  const ProgramRun solve = run_program({"solve", scene_, "-o", result_, "--accuracy", "draft", "--no-error"});
  ASSERT_EQ(solve.exit_code, 0) << solve.err;
  for (const char* detail : {"light", "model"}) {
    for (const char* name : {"a.glb", "a.ply", "a.obj"}) {
      const ProgramRun run = run_program({"bake", result_, "-o", folder_ / name, "--detail", detail});
      EXPECT_EQ(run.exit_code, 0) << run.err;
      EXPECT_EQ(run.err, "");
      EXPECT_NE(run.out.find(std::string("lightmap ") + (folder_ / name)), std::string::npos) << run.out;
    }
    const GlbFile glb(folder_ / "a.glb");
    std::size_t vertices = 0;
    for (const auto& mesh : glb.json["meshes"])
      for (const auto& primitive : mesh["primitives"])
        for (const double E : glb.numbers(primitive["attributes"]["_IRRADIANCE"])) {
          EXPECT_NEAR(E / box_.radiosity(), 1, 0.02);
          ++vertices;
        }
    if (*detail == 'l') {
      EXPECT_EQ(vertices, 3 * read_result(result_).points.size());
    } else {
      EXPECT_EQ(vertices, 3u * 24) << "four corners of six walls";
    }
  }
}

TEST_F(Bake, ExposureIsInStops) {
  const auto exposure = [&](const char* ev) {
    const ProgramRun run = run_program({"bake", result_, "-o", folder_ / "a.glb", "--exposure", ev});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return GlbFile(folder_ / "a.glb").json["meshes"][0]["extras"]["exposure"].get<double>();
  };
  EXPECT_NEAR(exposure("1") / exposure("0"), 2, 1e-12);
  EXPECT_NEAR(exposure("-2.5") / exposure("0"), std::exp2(-2.5), 1e-12);
}

TEST_F(Bake, WritesTheSameBytesForAnyNumberOfThreads) {
  const auto baked = [&](const std::string& threads) {
    const std::string file = folder_ / (threads + ".glb");
    const ProgramRun run = run_program({"bake", result_, "-o", file, "--detail", "model", "--threads", threads});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return read_text(file);
  };
  const std::string one = baked("1");
  EXPECT_TRUE(one.starts_with("glTF"));
  EXPECT_EQ(one, baked("2"));
}

TEST_F(Bake, FindsTheSceneBesideTheResultOrWhereItIsTold) {
  const TempFolder other;
  for (const char* name : {"room.json", "room.obj", "room.vtp"}) fs::copy(folder_ / name, other / name);
  fs::remove(folder_ / "room.json");
  EXPECT_EQ(run_program({"bake", other / "room.vtp", "-o", other / "a.glb", "--detail", "model"}).exit_code, 0);
  expect_refusal({result_, "-o", folder_ / "a.glb", "--detail", "model"}, 3, "--scene FILE");
  const ProgramRun run =
      run_program({"bake", result_, "-o", folder_ / "a.glb", "--detail", "model", "--scene", other / "room.json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST_F(Bake, WarnsWhenTheModelWasChanged) {
  BoxScene larger;
  larger.size.x += 0.5;
  larger.write(folder_);
  const ProgramRun run = run_program({"bake", result_, "-o", folder_ / "a.glb", "--detail", "model"});
  EXPECT_EQ(run.exit_code, 0);
  // Of 59 m2 the wall at the far end, 7.5 m2, has no face any more.
  EXPECT_NE(run.err.find("has no face where 12.7 % of the solution's surfaces are"), std::string::npos) << run.err;
}

TEST_F(Bake, RefusesWhatItCannotUse) {
  const std::string out = folder_ / "a.glb";
  expect_refusal({scene_, "-o", out}, 3, "is no VTK PolyData");
  expect_refusal({folder_ / "none.vtp", "-o", out}, 3, "no such file");
  expect_refusal({folder_.write("cut.vtp", read_text(result_).substr(0, 5000)), "-o", out}, 3, "cut short");
  std::string older = read_text(result_);
  older.replace(older.find("result_format"), 13, "results_forms");
  expect_refusal({folder_.write("older.vtp", older), "-o", out}, 3, "solve the scene again");
  expect_refusal({result_, "-o", folder_ / "a.fbx"}, 2, "does not end in .ply, .obj, .glb or .exr");
  expect_refusal({result_}, 2, "--output");
  expect_refusal({result_, "-o", out, "--detail", "fine"}, 2, "light|model");
  expect_refusal({result_, "-o", out, "--exposure", "bright"}, 2, "--exposure");
  expect_refusal({result_, "-o", out, "--scene", scene_}, 2, "--detail model only");
  expect_refusal({result_, "-o", folder_ / "none/a.glb"}, 3, "does not exist");
  expect_refusal({result_, "-o", out, "--detail", "model", "--scene", folder_ / "none.json"}, 3, "no such file");
  fs::create_symlink(result_, folder_ / "link.glb");
  expect_refusal({result_, "-o", folder_ / "link.glb"}, 3, "is the input");
  fs::create_hard_link(folder_ / "room.obj", folder_ / "hard.obj");
  expect_refusal({result_, "-o", folder_ / "hard.obj", "--detail", "model"}, 3, "is a file of the scene");
}

}  // namespace
}  // namespace clerestory
