// Whatever is wrong, the program says what, where and what to do, with the right exit code, and writes nothing.

#include <gtest/gtest.h>

#include "tests/support/box_scene.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

/// Runs, and expects this exit code, one message that holds `words`, and no file but the input.
void expect_refusal(const std::vector<std::string>& arguments, int exit_code, const std::vector<std::string>& words) {
  const ProgramRun run = run_program(arguments);
  std::string line;
  for (const std::string& a : arguments) line += a + " ";
  EXPECT_EQ(run.exit_code, exit_code) << line << "\n" << run.err;
  for (const std::string& word : words) EXPECT_NE(run.err.find(word), std::string::npos) << line << "\n" << run.err;
  EXPECT_EQ(run.err.rfind("error: ", 0) == 0 || run.err.find("\nerror: ") != std::string::npos, true) << run.err;
  EXPECT_EQ(run.err.find("\nerror: ", 1), run.err.rfind("\nerror: ")) << "more than one message\n" << run.err;
  EXPECT_EQ(run.err.find("internal failure"), std::string::npos) << run.err;
}

class BadUsage : public testing::Test {
 protected:
  TempFolder folder_;
  std::string scene_ = BoxScene{}.write(folder_), out_ = folder_ / "out.vtp";

  void TearDown() override { EXPECT_EQ(folder_.listing(), "room.json room.obj "); }
};

TEST_F(BadUsage, ExitsTwoAndSuggestsTheNearestName) {
  expect_refusal({}, 2, {"subcommand"});
  expect_refusal({"slove", scene_, "-o", out_}, 2, {"'slove'", "did you mean 'solve'?"});
  expect_refusal({"solve", scene_, "-o", out_, "--metod", "path"}, 2, {"'--metod'", "did you mean '--method'?"});
  expect_refusal({"solve", scene_, "-o", out_, "--method", "progresive"}, 2, {"did you mean 'progressive'?"});
  expect_refusal({"solve", scene_, "-o", out_, "--method", "radiosity"}, 2, {"known are hierarchical, progressive"});
  expect_refusal({"solve", scene_, "-o", out_, "--accuracy", "finest"}, 2, {"did you mean 'fine'?"});
  expect_refusal({"solve", scene_, "-o", out_, "--oracle", "fb"}, 2, {"'fb' is not known", "bf"});
  expect_refusal({"solve"}, 2, {"required"});
  expect_refusal({"solve", scene_}, 2, {"--output"});
  expect_refusal({"solve", scene_, "-o"}, 2, {"--output"});
  expect_refusal({"solve", scene_, "other.json", "-o", out_}, 2, {"'other.json'", "too many"});
  expect_refusal({"solve", scene_, "-o", folder_ / "out.vtk"}, 2, {".vtp"});
  expect_refusal({"solve", scene_, "-o", out_, "--channels", "2"}, 2, {"--channels", "1|3"});
  expect_refusal({"solve", scene_, "-o", out_, "--unit", "furlong"}, 2, {"--unit", "mm"});
  expect_refusal({"solve", scene_, "-o", out_, "--up", "x"}, 2, {"--up"});
  for (const char* value : {"0", "-1", "nan", "inf", "five", ""}) {
    expect_refusal({"solve", scene_, "-o", out_, "--max-element", value}, 2, {"--max-element"});
    expect_refusal({"solve", scene_, "-o", out_, "--time-limit", value}, 2, {"--time-limit"});
    expect_refusal({"solve", scene_, "-o", out_, "--target-error", value}, 2, {"--target-error"});
  }
  for (const char* value : {"0", "7", "4097", "-1", "many", ""})
    expect_refusal({"solve", scene_, "-o", out_, "--error-samples", value}, 2, {"--error-samples"});
  expect_refusal({"solve", scene_, "-o", out_, "--no-error", "--target-error", "0.02"}, 2,
                 {"--no-error", "--target-error"});
  for (const char* value : {"-0.001", "nan", "inf", "fine", ""})
    expect_refusal({"solve", scene_, "-o", out_, "--detail", value}, 2, {"--detail", "0 or more"});
  for (const char* value : {"0", "-1", "2Q", "much", "1e99", "nan", ""})
    expect_refusal({"solve", scene_, "-o", out_, "--memory-limit", value}, 2, {"--memory-limit", "2GiB"});
  for (const char* value : {"-1", "two", "100000", "1e99"})
    expect_refusal({"solve", scene_, "-o", out_, "--threads", value}, 2, {"--threads"});
  for (const char* value : {"blue", "-1", "1.5", "", "9223372036854775808"})
    expect_refusal({"solve", scene_, "-o", out_, "--seed", value}, 2, {"--seed"});
  const ProgramRun run = run_program({"solve", scene_, "-o", out_, "--threads", std::string(100'000, '9')});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_LT(run.err.size(), 1'000u) << "words that are long are cut";
}

TEST_F(BadUsage, AnOutputThatCannotBeWrittenIsRefusedBeforeSolving) {
  // A model that would take minutes: the refusal comes first.
  const std::vector<std::string> base = {"solve", shipped_scene("office.json"), "--accuracy", "fine", "--max-element",
                                         "0.02"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), base.begin(), base.end());
    return more;
  };
  expect_refusal(with({"-o", folder_ / "no/such/out.vtp"}), 3, {"does not exist"});
  expect_refusal(with({"-o", folder_ / "room.obj/out.vtp"}), 3, {"cannot be written"});
  expect_refusal(with({"-o", out_, "--report", folder_ / "no/report.json"}), 3, {"report.json", "does not exist"});
  expect_refusal(with({"-o", out_, "--sensors-out", folder_ / "no/s.csv"}), 3, {"s.csv", "does not exist"});
  expect_refusal(with({"-o", out_, "--log", folder_ / "no/run.log"}), 3, {"run.log"});
}

TEST_F(BadUsage, TheReportOrLogOverTheSceneIsRefusedAndTheSceneStays) {
  const std::string before = read_text(scene_);
  expect_refusal({"solve", scene_, "-o", out_, "--report", scene_}, 3, {"--report", "is the input"});
  expect_refusal({"check", scene_, "--log", folder_ / "./room.json"}, 3, {"--log", "is the input"});
  EXPECT_EQ(read_text(scene_), before);
}

TEST_F(BadUsage, TwoFilesOfOneNameAreRefusedBeforeAnythingIsWritten) {
  expect_refusal({"solve", scene_, "-o", out_, "--report", out_}, 3, {"--report", "-o too"});
  expect_refusal({"solve", scene_, "-o", out_, "--log", folder_ / "./out.vtp"}, 3, {"--log", "-o too"});
  expect_refusal({"solve", scene_, "-o", out_, "--sensors-out", out_}, 3, {"--sensors-out", "-o too"});
  expect_refusal({"solve", scene_, "-o", out_, "--report", folder_ / "a", "--log", folder_ / "a"}, 3, {"--log too"});
  expect_refusal({"solve", scene_, "-o", out_, "--sensors", folder_ / "s.csv", "--sensors-out", folder_ / "s.csv"}, 3,
                 {"--sensors-out", "--sensors too"});
  // Without --sensors-out the points would go to OUT.sensors.csv.
  expect_refusal({"solve", scene_, "-o", out_, "--sensors", folder_ / "out.sensors.csv"}, 3, {"--sensors too"});
  expect_refusal({"mesh", scene_, "-o", out_, "--report", out_}, 3, {"--report", "-o too"});
  expect_refusal({"formfactors", scene_, "-o", folder_ / "f.csv", "--log", folder_ / "f.csv"}, 3, {"--log", "-o too"});
  expect_refusal({"check", scene_, "--report", folder_ / "a", "--log", folder_ / "a"}, 3, {"--report", "--log too"});
}

class BadInput : public testing::Test {
 protected:
  TempFolder folder_;

  void expect_scene_refused(const std::string& json, const std::vector<std::string>& words) {
    const std::string file = folder_.write("bad.json", json);
    expect_refusal({"solve", file, "-o", folder_ / "out.vtp"}, 3, words);
    EXPECT_EQ(folder_.listing().find("out"), std::string::npos) << folder_.listing();
  }
  void expect_room_refused(const std::string& entries, const std::vector<std::string>& words) {
    BoxScene{}.write(folder_);
    expect_scene_refused(R"({ "geometry": [{ "file": "room.obj" }], )" + entries + " }", words);
  }
};

TEST_F(BadInput, FilesOfEveryFormatMissingEmptyOrGarbage) {
  for (const char* extension : {".json", ".obj", ".glb", ".gltf", ".ply", ".stl", ".off", ".dae", ".fbx", ".ifc"}) {
    const std::string missing = folder_ / (std::string("missing") + extension);
    expect_refusal({"check", missing}, 3, {"missing"});
    expect_refusal({"check", folder_.write(std::string("empty") + extension, "")}, 3, {"empty"});
    std::string garbage;
    for (unsigned i = 0; i < 5000; ++i) garbage += static_cast<char>((i * 2654435761u) >> 13);
    expect_refusal({"check", folder_.write(std::string("garbage") + extension, garbage)}, 3, {"garbage"});
  }
  expect_refusal({"check", folder_.write("model.xyz", "1 2 3")}, 3, {"model.xyz"});
  expect_refusal({"check", folder_ / "."}, 3, {});
}

TEST_F(BadInput, SceneFilesThatAreNotRight) {
  expect_scene_refused("{ \"geometry\": [ }", {"bad.json:1:"});
  expect_room_refused(R"("materials": { "wall": { "exitance": 1 } }, "skye": {})", {"skye", "did you mean 'sky'?"});
  expect_room_refused(R"("materials": { "wall": { "reflectanse": 0.5 } })",
                      {"reflectanse", "did you mean 'reflectance'?"});
  expect_room_refused(R"("materials": { "wall": { "reflectance": 1.0 } })", {"reflectance", "1"});
  expect_room_refused(R"("materials": { "wall": { "reflectance": -0.1 } })", {"reflectance", "-0.1"});
  expect_room_refused(R"("materials": { "wall": { "reflectance": "white" } })", {"reflectance"});
  expect_room_refused(R"("materials": { "wall": { "reflectance": 0.5, "exitance": [1, 2] } })", {"exitance"});
  expect_room_refused(R"("materials": { "wall": { "exitance": 1 } }, "sky": { "model": "cie-overcsat" })",
                      {"cie-overcsat", "did you mean 'cie-overcast'?"});
  expect_room_refused(R"("materials": { "wall": { "exitance": 1 } }, "solver": { "method": "radiosity" })",
                      {"solver", "radiosity"});
  expect_room_refused(R"("solver": { "memory_limit": "2 Q" })", {"solver.memory_limit '2 Q'", "2GiB"});
  expect_room_refused(R"("solver": { "memory_limit": -5 })", {"solver.memory_limit '-5'"});
  expect_room_refused(R"("solver": { "memory_limit": true })", {"solver.memory_limit"});
  expect_scene_refused(R"({ "geometry": [{ "file": "nowhere.obj" }] })", {"nowhere.obj"});
}

TEST_F(BadInput, ModelsThatAreNotRight) {
  const auto refuse = [&](const std::string& name, const std::string& text, const std::vector<std::string>& words) {
    expect_refusal({"solve", folder_.write(name, text), "-o", folder_ / "out.vtp", "--sky", "uniform:1000"}, 3, words);
  };
  refuse("none.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", {"none.obj"});
  refuse("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", {"flat.obj"});
  refuse("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", {"nan.obj"});
  refuse("huge.obj", "v 0 0 1e300\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", {"huge.obj"});
  refuse("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", {"index.obj", "9"});
}

TEST_F(BadInput, NoLightAtAllIsRefusedAndSaysHowToAddSome) {
  BoxScene{.M = 0}.write(folder_);
  expect_refusal({"solve", folder_ / "room.json", "-o", folder_ / "out.vtp"}, 3, {"no light", "--sky", "luminaires"});
  expect_refusal({"solve", folder_ / "room.obj", "-o", folder_ / "out.vtp"}, 3, {"no light", "--sky"});
}

TEST_F(BadInput, ASunThatHasSetIsNoLight) {
  BoxScene{.M = 0}.write(folder_);
  expect_scene_refused(
      R"({ "geometry": [{ "file": "room.obj" }], "sun": { "direction": [0, 1, -1], "normal_illuminance": 1000 } })",
      {"not above the horizon", "no light at all"});
}

TEST_F(BadInput, SensorRowsAreNamedByTheirNumber) {
  const std::string scene = BoxScene{}.write(folder_);
  const std::string rows = folder_.write("rows.csv", "x,y,z,nx,ny,nz\n1,1,1,0,0,1\n1,1,1,0,zero,1\n");
  expect_refusal({"solve", scene, "-o", folder_ / "out.vtp", "--sensors", rows}, 3, {"rows.csv", "3"});
  const std::string normal = folder_.write("normal.csv", "1,1,1,0,0,0\n");
  expect_refusal({"solve", scene, "-o", folder_ / "out.vtp", "--sensors", normal}, 3, {"normal.csv"});
}

TEST_F(BadInput, SensorKindsSayWhatTheyNeed) {
  const std::string grid = R"("origin": [1, 1, 1], "u": [1, 0, 0], "v": [0, 1, 0], "spacing": 1 } ])";
  const auto expect = [&](const std::string& members, const std::vector<std::string>& words) {
    expect_room_refused(R"("materials": { "wall": { "exitance": 1 } }, "sensors": [ { )" + members + ", " + grid,
                        words);
  };
  expect(R"("kind": "cylindric")", {"sensors[0].kind 'cylindric' is not known; did you mean 'cylindrical'?"});
  expect(R"("kind": "camera")", {"sensors[0].camera is missing"});
  expect(R"("kind": "camera", "camera": [2, 1, 1])", {"sensors[0].camera", "point 2 at (2, 1, 1)", "move one"});
  expect(R"("threshold": 0)", {"sensors[0].threshold = 0 is outside (0, 1e15]; it is in lux"});
}

TEST_F(BadInput, WhatIsOnlyOddIsAWarning) {
  BoxScene{}.write(folder_);
  const auto warns = [&](const std::string& entries, const std::vector<std::string>& options,
                         const std::vector<std::string>& words) {
    std::vector<std::string> arguments = {
        "solve",
        folder_.write("odd.json", R"({ "geometry": [{ "file": "room.obj" }], )" + entries + " }"),
        "-o",
        folder_ / "out.vtp",
        "--max-element",
        "1"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramRun run = run_program(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.err.find("warning: "), std::string::npos);
    for (const std::string& word : words) EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
  };
  warns(R"("luminaires": [{ "type": "point", "position": [2, 1.5, 30], "luminous_flux": 1000 }])", {},
        {"outside every room"});
  warns(R"("materials": { "wall": { "exitance": 1 }, "marble": { "reflectance": 0.6 } })", {}, {"marble"});
  warns(R"("materials": { "wal": { "reflectance": 0.6 } }, "sky": {})", {}, {"'wal'", "did you mean 'wall'?"});

  // A solid block in the room, and a sensor in the middle of it.
  const std::string block = folder_.write("block.csv", "2,1.5,1,0,0,1\n1,1.5,0.5,0,0,1\n");
  folder_.write("room.obj", read_text(folder_ / "room.obj") +
                                "v 0.5 1 0.2\nv 1.5 1 0.2\nv 0.5 2 0.2\nv 1.5 2 0.2\nv 0.5 1 1\nv 1.5 1 1\nv 0.5 2 1\n"
                                "v 1.5 2 1\nusemtl block\nf 9 11 12 10\nf 13 14 16 15\nf 9 10 14 13\nf 11 15 16 12\n"
                                "f 9 13 15 11\nf 10 12 16 14\n");
  warns(R"("materials": { "wall": { "exitance": 1, "sides": 1 }, "block": { "reflectance": 0.5 } })",
        {"--sensors", block}, {"row 2", "inside a solid"});
}

TEST_F(BadInput, AModelInMillimetresReadAsMetresIsAWarningAboutItsSize) {
  BoxScene{.size = {4000, 3000, 2500}}.write(folder_);
  const ProgramRun run = run_program({"check", folder_ / "room.obj"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("millimetres"), std::string::npos) << run.err;
  const ProgramRun right = run_program({"check", folder_ / "room.obj", "--unit", "mm"});
  EXPECT_EQ(right.err.find("millimetres"), std::string::npos) << right.err;
  EXPECT_NE(right.out.find("4.00 x 3.00 x 2.50 m"), std::string::npos) << right.out;
}

}  // namespace
}  // namespace clerestory
