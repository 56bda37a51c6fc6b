// clerestory render: pictures as a user asks for them.

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/run_program.h"
#include "tests/support/solved_box.h"

namespace clerestory {
namespace {

/// A furnace.
class Render : public testing::Test {
 protected:
  ProgramRun render(const std::string& output, std::vector<std::string> more, const std::string& size = "32x18") {
    std::vector<std::string> arguments{"render", result_, "-o", folder_ / output, "--size", size};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
  std::string text_of(const std::string& name) { return read_text(folder_ / name); }
  static unsigned width_of(const std::string& png) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(png.at(i))); };
    return byte(18) << 8 | byte(19);
  }
  void expect_refused(const std::vector<std::string>& more, int code, const std::string& why,
                      const std::string& size = "32x18", const std::string& output = "no.png") {
    const ProgramRun run = render(output, more, size);
    EXPECT_EQ(run.exit_code, code) << why;
    EXPECT_NE(run.err.find(why), run.err.npos) << run.err;
    EXPECT_EQ(folder_.listing().find("no."), std::string::npos) << why;
  }

  TempFolder folder_;
  std::string result_ = SolvedBox{}.write(folder_);
};

TEST_F(Render, WritesPicturesOfEveryKindAndSaysTheirScale) {
  struct Kind {
    std::vector<std::string> options;
    std::string said;
    bool has_legend;
  };
  const std::vector<Kind> kinds = {
      {{}, "0 EV from the automatic one", false},
      {{"--eye", "1,1,1.2", "--target", "3,2,1", "--fov", "90", "--exposure", "2"},
       "2.00 EV from the automatic one",
       false},
      {{"--eye", "1,1,1.2", "--target", "3,2,1", "--fisheye", "--show", "luminance"}, "[cd/m2]", true},
      {{"--plan", "1.2", "--show", "illuminance", "--isolux", "100,30000", "--range", "0:50000"}, "[lux]", true},
      {{"--section", "x=2", "--show", "irradiance", "--log-scale"}, "[W/m2]", true},
  };
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const std::string name = std::to_string(i) + ".png";
    const ProgramRun run = render(name, kinds[i].options);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find(kinds[i].said), run.out.npos) << run.out;
    const std::string png = text_of(name);
    ASSERT_TRUE(png.starts_with("\x89PNG") && png.size() > 60) << i;
    EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND") << i;
    if (kinds[i].has_legend)
      EXPECT_GT(width_of(png), 80u) << "beside the picture";
    else
      EXPECT_EQ(width_of(png), 32u);
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(png, text_of(std::to_string(k) + ".png")) << i << ' ' << k;
  }
}

TEST_F(Render, ThreadsNeverChangeABit) {
  // A sheet of glass through the room, and a mirror behind it: rays are split and turned.
  SolvedBox seen;
  seen.E = [](const Vec3& p) { return 100 + 10 * p.x + 20 * p.y + 30 * p.z; };
  seen.more_materials.resize(2);
  seen.more_materials[0].name = "pane", seen.more_materials[0].kind = MaterialKind::glass;
  seen.more_materials[0].transmittance = Spectrum(0.7);
  seen.more_materials[1].name = "mirror", seen.more_materials[1].kind = MaterialKind::mirror;
  seen.more_materials[1].reflectance = Spectrum(0.9);
  for (const auto& [x, material] : {std::pair{2.0, 1u}, {3.5, 2u}}) {
    const Vec3 low{x, 0.5, 0.5}, side{x, 2.5, 0.5}, high{x, 2.5, 2}, up{x, 0.5, 2};
    seen.around.panes.push_back({{low, side, high}, material, 0});
    seen.around.panes.push_back({{low, high, up}, material, 0});
  }
  const auto picture = [&](const std::string& threads) {
    const std::string name = "by" + threads + ".png";
    const ProgramRun run =
        render(name, {"--eye", "0.5,0.7,1", "--target", "4,1.8,1.3", "--threads", threads}, "200x100");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return text_of(name);
  };
  const std::string without = picture("1");
  seen.write(folder_);
  const std::string one = picture("1");
  EXPECT_FALSE(one.empty());
  EXPECT_NE(one, without) << "panes are seen";
  EXPECT_EQ(one, picture("4"));
}

TEST_F(Render, RefusesWhatItCannotShow) {
  expect_refused({"--show", "iluminance"}, 3, "did you mean 'illuminance'?");
  expect_refused({}, 3, "does not exist", "32x18", "none/no.png");
  const ProgramRun run = run_program({"render", folder_ / "room.json", "-o", folder_ / "no.png"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("solve"), run.err.npos) << run.err;
  const std::string before = read_text(result_);
  const ProgramRun itself = run_program({"render", result_, "-o", result_});
  EXPECT_EQ(itself.exit_code, 2) << "not a picture's name";
  EXPECT_EQ(read_text(result_), before);
}

TEST_F(Render, SaysWhatDoesNotGoTogether) {
  expect_refused({"--eye", "1,1,1"}, 2, "--eye needs --target");
  expect_refused({"--eye", "1,1,1", "--target", "1,1,1"}, 2, "the same place");
  expect_refused({"--eye", "1,1", "--target", "1,1,1"}, 2, "is not x,y,z");
  expect_refused({"--eye", "1,1,1", "--target", "2,1,1", "--fov", "180"}, 2, "180 is not an angle");
  expect_refused({"--plan", "1", "--section", "x=1"}, 2, "excludes");
  expect_refused({"--section", "z=1"}, 2, "is not x=METRES");
  expect_refused({"--fisheye"}, 2, "--fisheye needs");
  expect_refused({}, 2, "WIDTHxHEIGHT", "0x10");
  expect_refused({}, 2, "67 million", "65535x65535");
  expect_refused({"--show", "illuminance", "--range", "10:5"}, 2, "not below");
  expect_refused({"--show", "illuminance", "--range", "1:1.0000000000000002"}, 2, "no scale has room");
  expect_refused({"--show", "illuminance", "--range", "0:5", "--log-scale"}, 2, "above 0");
  expect_refused({"--range", "1:5"}, 2, "false colours");
  expect_refused({"--isolux", "1,,2"}, 2, "not numbers");
  expect_refused({"--samples", "0"}, 2, "--samples");
  expect_refused({"--isolux", "100"}, 2, "an EXR holds the values themselves", "32x18", "no.exr");
}

TEST_F(Render, FindsLightByRaysOnlyInTheSceneThatWasSolved) {
  const std::vector<std::string> view{"--eye", "1,1,1.2", "--target", "3,2,1"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), view.begin(), view.end());
    return more;
  };
  // What glows is seen by the field, which is all there is without lamps; and a final gather sees the furnace.
  ASSERT_EQ(render("field.png", view).exit_code, 0);
  for (const std::vector<std::string>& option : {std::vector<std::string>{"--raytrace"}, {"--final-gather", "16"}}) {
    const ProgramRun run = render("rays.png", with(option));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(text_of("rays.png"), text_of("field.png")) << option.front();
  }
  expect_refused(with({"--scene", folder_ / "room.json"}), 2, "--scene is for --camera, --raytrace");
  expect_refused(with({"--final-gather", "8"}), 2, "--final-gather");
  expect_refused(with({"--raytrace", "--show", "irradiance"}), 3, "'irradiance' is not found by rays; --raytrace goes");
  BoxScene other;
  other.size.z += 0.5;
  other.write(folder_);
  expect_refused(with({"--raytrace"}), 3, "Solve it again");
  other = {};
  other.rho = 0.4;
  other.write(folder_);
  expect_refused(with({"--raytrace"}), 3, "its material 'wall' is another");
  BoxScene{}.write(folder_);
  const std::string moved = folder_ / "moved.json";
  std::filesystem::rename(folder_ / "room.json", moved);
  expect_refused(with({"--final-gather", "64"}), 3, "not there any more; say where it is: --scene FILE");
  EXPECT_EQ(render("found.png", with({"--raytrace", "--scene", moved})).exit_code, 0);
  EXPECT_EQ(text_of("found.png"), text_of("field.png"));
}

TEST_F(Render, SaysWhenNothingIsSeen) {
  const ProgramRun away = render("view.png", {"--eye", "2,1.5,-3", "--target", "2,1.5,-9"});
  EXPECT_EQ(away.exit_code, 0) << away.err;
  EXPECT_NE(away.err.find("nothing is seen"), away.err.npos) << away.err;
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
  const std::string moved = folder / "moved.gltf";
  std::filesystem::rename(folder / "model.gltf", moved);
  const ProgramRun found = run_program(
      {"render", solved, "-o", folder / "view.png", "--size", "20x20", "--camera", "Above", "--scene", moved});
  EXPECT_EQ(found.exit_code, 0) << found.err;
  const ProgramRun gone = look("Above");
  EXPECT_EQ(gone.exit_code, 3);
  EXPECT_NE(gone.err.find("not there any more"), gone.err.npos) << gone.err;
}

}  // namespace
}  // namespace clerestory
