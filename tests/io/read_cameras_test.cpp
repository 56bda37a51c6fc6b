// Cameras of glTF files, in the frame of the scene.

#include "io/read_cameras.h"

#include <gtest/gtest.h>

#include "solver/model/error.h"
#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

constexpr const char* kModel = R"({ "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0] }],
  "nodes": [{ "translation": [1, 0, 0], "scale": [2, 2, 2], "children": [1, 2] },
            { "name": "Eye", "camera": 0, "translation": [0, 1, 0] }, { "camera": 1 }],
  "cameras": [{ "name": "Lens", "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1 } },
              { "type": "orthographic", "orthographic": { "xmag": 3, "ymag": 1.5, "znear": 0, "zfar": 9 } }] })";

void expect_near(const Vec3& a, const Vec3& b) { EXPECT_LT(length(a - b), 1e-12) << a.x << ' ' << a.y << ' ' << a.z; }

TEST(ReadCameras, TurnsThemAsItTurnsTheModel) {
  const TempFolder folder;
  const auto cameras = read_cameras(folder.write("a.gltf", kModel));
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[0].names, (std::vector<std::string>{"Eye", "Lens"}));
  expect_near(cameras[0].eye, {1, 0, 2});      // (1, 2, 0) of y up
  expect_near(cameras[0].forward, {0, 1, 0});  // -z becomes +y
  expect_near(cameras[0].up, {0, 0, 1});
  EXPECT_EQ(cameras[0].vertical_angle, 0.8);
  EXPECT_EQ(cameras[1].names, (std::vector<std::string>{"camera 2"}));
  EXPECT_FALSE(cameras[1].vertical_angle);
  EXPECT_DOUBLE_EQ(cameras[1].half_height, 3) << "twice as large, as its node is";
}

TEST(ReadCameras, PutsEachWhereTheSceneFilePutsItsModel) {
  const TempFolder folder;
  folder.write("a.gltf", kModel), folder.write("b.obj", "v 0 0 0\n");
  const auto cameras = read_cameras(folder.write("room.json", R"({ "geometry": [{ "file": "b.obj" },
    { "file": "a.gltf", "transform": [0, -1, 0, 10,  1, 0, 0, 20,  0, 0, 1, 30,  0, 0, 0, 1] }, { "file": "a.gltf" }] })"));
  ASSERT_EQ(cameras.size(), 4u);
  expect_near(cameras[0].eye, {10, 21, 32});
  expect_near(cameras[0].forward, {-1, 0, 0});
  expect_near(cameras[2].eye, {1, 0, 2});
}

TEST(ReadCameras, RefusesOnesThatShowNothing) {
  const TempFolder folder;
  const auto refusal = [&](const std::string& camera) -> std::string {
    const std::string file = folder.write("a.gltf", R"({ "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0] }],
      "nodes": [{ "camera": 0 }], "cameras": [)" + camera +
                                                        "] }");
    try {
      read_cameras(file);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal(R"({ "type": "perspective", "perspective": { "yfov": 4 } })").find("yfov = 4"), std::string::npos);
  EXPECT_NE(refusal(R"({ "type": "perspective" })").find("has no \"perspective\""), std::string::npos);
  EXPECT_NE(refusal(R"({ "type": "round" })").find("'round' is not known"), std::string::npos);
  EXPECT_NE(refusal("").find("cameras[0] is used"), std::string::npos);
}

}  // namespace
}  // namespace clerestory
