// clerestory render: pictures as a user asks for them.

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/box_scene.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

/// A furnace, solved once for all tests here.
class Render : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    const ProgramRun run =
        run_program({"solve", BoxScene{}.write(*folder_), "-o", result(), "--accuracy", "draft", "--no-error"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string result() { return *folder_ / "room.vtp"; }
  static ProgramRun render(const std::string& output, std::vector<std::string> more,
                           const std::string& size = "32x18") {
    std::vector<std::string> arguments{"render", result(), "-o", *folder_ / output, "--size", size};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
  static std::string text_of(const std::string& name) { return read_text(*folder_ / name); }
  static unsigned width_of(const std::string& png) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(png[i])); };
    return byte(18) << 8 | byte(19);
  }
  static void expect_refused(const std::vector<std::string>& more, int code, const std::string& why) {
    const ProgramRun run = render("no.png", more);
    EXPECT_EQ(run.exit_code, code) << why;
    EXPECT_NE(run.err.find(why), run.err.npos) << run.err;
    EXPECT_EQ(folder_->listing().find("no.png"), std::string::npos) << why;
  }
  static TempFolder* folder_;
};
TempFolder* Render::folder_ = nullptr;

TEST_F(Render, WritesPicturesOfEveryKind) {
  const std::vector<std::vector<std::string>> kinds = {
      {},
      {"--fit", "--exposure", "1"},
      {"--eye", "1,1,1.2", "--target", "3,2,1", "--fov", "90"},
      {"--eye", "1,1,1.2", "--target", "3,2,1", "--fisheye", "--show", "luminance"},
      {"--plan", "1.2", "--show", "illuminance", "--isolux", "100,30000", "--range", "0:50000"},
      {"--section", "x=2", "--show", "irradiance", "--log-scale"},
  };
  for (const auto& kind : kinds) {
    const ProgramRun run = render("view.png", kind);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(text_of("view.png").starts_with("\x89PNG")) << kind.size();
  }
}

TEST_F(Render, HasTheSizeAskedForAndTheLegendBesideIt) {
  render("plain.png", {}), render("false.png", {"--show", "illuminance"});
  EXPECT_EQ(width_of(text_of("plain.png")), 32u);
  EXPECT_GT(width_of(text_of("false.png")), 80u);
}

TEST_F(Render, SaysTheExposureAndTheRange) {
  EXPECT_NE(render("view.png", {"--exposure", "2"}).out.find("2.00 EV"), std::string::npos);
  EXPECT_NE(render("view.png", {"--show", "illuminance"}).out.find("[lux]"), std::string::npos);
}

TEST_F(Render, ThreadsNeverChangeABit) {
  render("one.png", {"--show", "luminance", "--threads", "1"}, "200x100");
  render("four.png", {"--show", "luminance", "--threads", "4"}, "200x100");
  EXPECT_EQ(text_of("one.png"), text_of("four.png"));
}

TEST_F(Render, RefusesWhatItCannotShow) {
  expect_refused({"--show", "iluminance"}, 3, "did you mean 'illuminance'?");
  expect_refused({"--camera", "Kamera"}, 3, "say --eye and --target");
  expect_refused({"--plan", "-1"}, 3, "the model's z goes from 0 to 2.5 m");
  expect_refused({"--section", "x=40"}, 3, "nothing beyond the section at x = 40 m");
  const ProgramRun run = run_program({"render", BoxScene{}.write(*folder_), "-o", *folder_ / "no.png"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("solve"), run.err.npos) << run.err;
  const ProgramRun nowhere = run_program({"render", result(), "-o", *folder_ / "none/no.png"});
  EXPECT_EQ(nowhere.exit_code, 3);
  const ProgramRun itself = run_program({"render", result(), "-o", result()});
  EXPECT_EQ(itself.exit_code, 2) << "not a picture's name";
}

TEST_F(Render, SaysWhatDoesNotGoTogether) {
  expect_refused({"--eye", "1,1,1"}, 2, "--eye needs --target");
  expect_refused({"--eye", "1,1,1", "--target", "1,1,1"}, 2, "the same place");
  expect_refused({"--eye", "1,1", "--target", "1,1,1"}, 2, "is not x,y,z");
  expect_refused({"--eye", "1,1,1", "--target", "2,1,1", "--fov", "180"}, 2, "180 is not an angle");
  expect_refused({"--plan", "1", "--section", "x=1"}, 2, "excludes");
  expect_refused({"--section", "z=1"}, 2, "is not x=METRES");
  expect_refused({"--fisheye"}, 2, "--fisheye needs");
  EXPECT_NE(render("no.png", {}, "0x10").err.find("WIDTHxHEIGHT"), std::string::npos);
  EXPECT_NE(render("no.png", {}, "65535x65535").err.find("67 million"), std::string::npos);
  expect_refused({"--show", "illuminance", "--range", "10:5"}, 2, "not below");
  expect_refused({"--show", "illuminance", "--range", "1:1.0000000000000002"}, 2, "no scale has room");
  expect_refused({"--show", "illuminance", "--range", "0:5", "--log-scale"}, 2, "above 0");
  expect_refused({"--range", "1:5"}, 2, "false colours");
  expect_refused({"--isolux", "1,,2"}, 2, "not numbers");
  expect_refused({"--samples", "0"}, 2, "--samples");
  const ProgramRun run = render("no.exr", {"--isolux", "100"});
  EXPECT_EQ(run.exit_code, 2);
}

TEST_F(Render, SaysWhenNothingIsSeen) {
  const ProgramRun away = render("view.png", {"--eye", "2,1.5,-3", "--target", "2,1.5,-9"});
  EXPECT_EQ(away.exit_code, 0) << away.err;
  EXPECT_NE(away.err.find("nothing is seen"), away.err.npos) << away.err;
}

TEST_F(Render, WritesNumbersAsEXR) {
  const ProgramRun run = render("view.exr", {"--show", "illuminance", "--eye", "1,1,1", "--target", "3,2,1"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const std::string bytes = text_of("view.exr");
  EXPECT_TRUE(bytes.starts_with("\x76\x2f\x31\x01"));
  EXPECT_NE(bytes.find(std::string("A\0\2", 3)), bytes.npos) << "a channel A of floats";
  EXPECT_NE(bytes.find(std::string("Y\0\2", 3)), bytes.npos) << "a channel Y of floats";
}

TEST_F(Render, FindsTheCamerasOfAModelThatWasSolved) {
  // A lit square of 2 m on the ground (y up), and two cameras 5 m above it that look down.
  const TempFolder folder;
  std::string bytes(36 + 6, '\0');
  const float corner[9] = {-1, 0, -1, -1, 0, 1, 1, 0, 1};
  const unsigned short index[3] = {0, 1, 2};
  std::memcpy(bytes.data(), corner, 36), std::memcpy(bytes.data() + 36, index, 6);
  folder.write("model.bin", bytes);
  folder.write("model.gltf", R"({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0, 1, 2] }],
    "nodes": [{ "mesh": 0 },
              { "name": "Above", "camera": 0, "translation": [0, 5, 0], "rotation": [-0.70710678, 0, 0, 0.70710678] },
              { "name": "Flat", "camera": 1, "translation": [0, 5, 0], "rotation": [-0.70710678, 0, 0, 0.70710678] }],
    "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } },
                { "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 10 } }],
    "buffers": [{ "uri": "model.bin", "byteLength": 42 }],
    "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
    "bufferViews": [{ "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": 6 }],
    "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                    "min": [-1, 0, -1], "max": [1, 0, 1] },
                  { "bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR" }] })");
  const std::string solved = folder / "model.vtp";
  ASSERT_EQ(run_program({"solve", folder / "model.gltf", "--sky", "uniform:1000", "-o", solved, "--accuracy", "draft",
                         "--no-error"})
                .exit_code,
            0);
  const auto look = [&](const std::string& camera) {
    return run_program({"render", solved, "-o", folder / "view.png", "--size", "20x20", "--camera", camera});
  };
  for (const char* name : {"Above", "Flat"}) {
    const ProgramRun run = look(name);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err.find("nothing is seen"), run.err.npos) << run.err;
  }
  EXPECT_NE(look("above it").err.find("'Above'"), std::string::npos) << look("above it").err;
  std::filesystem::remove(folder / "model.gltf");
  const ProgramRun gone = look("Above");
  EXPECT_EQ(gone.exit_code, 3);
  EXPECT_NE(gone.err.find("not there any more"), gone.err.npos) << gone.err;
}

}  // namespace
}  // namespace clerestory
