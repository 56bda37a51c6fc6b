#include "solver/model/sky_image.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/io/paint_image.h"
#include "tests/io/reading.h"

namespace clerestory {
namespace {

class SkyImageFile : public ::testing::Test {
 protected:
  SkyImageFile() { folder_.write("room.obj", kRoomObj); }

  /// A picture of one grey or three channels; the extension says the format.
  void paint(const std::string& name, int width, int height, int channels, const std::vector<float>& pixels) {
    ASSERT_TRUE(paint_image(folder_ / name, width, height, channels, pixels));
  }
  std::string with(const std::string& sky) {
    return folder_.write("s.json", R"({ "geometry": [{ "file": "room.obj" }], "sky": )" + sky + " }");
  }

  TempFolder folder_;
};

TEST_F(SkyImageFile, GivesItsLuminanceAndItsHorizontalIlluminance) {
  for (const char* name : {"sky.hdr", "sky.exr"}) {
    paint(name, 64, 32, 3, std::vector<float>(3 * 64 * 32, 1000));
    const Scene scene = read_scene(with(std::string(R"({ "image": ")") + name + "\" }"));
    ASSERT_TRUE(scene.lights.sky);
    EXPECT_EQ(scene.lights.sky->model, SkyModel::image);
    EXPECT_TRUE(scene.lights.sky->image_has_ground);
    // 1000 cd/m2 all over give pi times as many lux; .hdr keeps 8 bits of mantissa.
    EXPECT_NEAR(179 * scene.lights.sky->horizontal_irradiance[0], 1000 * std::numbers::pi, 5);
    EXPECT_EQ(scene.channels(), 1);
  }
}

TEST_F(SkyImageFile, KeepsColoursTurnsWithNorthAndRotationAndScalesWhenAsked) {
  std::vector<float> pixels(3 * 8 * 4, 100);
  pixels[3 * (8 + 4)] = 300;  // red, in the second row right of the middle
  paint("sky.exr", 8, 4, 3, pixels);
  const Scene scene =
      read_scene(with(R"({ "model": "image", "image": "sky.exr", "rotation": 30, "ground_reflectance": 0.1,
                           "horizontal_illuminance": 17900 }, "location": { "north": 60 })"));
  const Sky& sky = *scene.lights.sky;
  EXPECT_EQ(scene.channels(), 3);
  EXPECT_FALSE(sky.image_has_ground);
  EXPECT_EQ(sky.image->middle_deg, 90);
  EXPECT_NEAR(0.2651 * sky.horizontal_irradiance[0] + 0.6701 * sky.horizontal_irradiance[1] +
                  0.0648 * sky.horizontal_irradiance[2],
              100, 1e-3);
  const Vec3 right_of_east = normalized({1, -0.4, 0.6});
  EXPECT_NEAR(sky.image->radiance(right_of_east)[0] / sky.image->radiance(right_of_east)[1], 3, 1e-6);
  EXPECT_NEAR(sky.image->radiance({0, 0.8, 0.6})[0] / sky.image->radiance({0, 0.8, 0.6})[1], 1, 1e-6);
  EXPECT_EQ(all_warnings(scene).find("s.json"), std::string::npos) << all_warnings(scene);
}

TEST_F(SkyImageFile, WhatIsNoSkyIsRefusedWithAReason) {
  EXPECT_EQ(refusal(with(R"({ "model": "image" })")),
            "s.json: sky.image is missing; the sky image needs the name of an .hdr or .exr file");
  EXPECT_NE(refusal(with(R"({ "image": "none.hdr" })")).find("s.json: sky.image 'none.hdr': there is no file"),
            std::string::npos);
  folder_.write("sky.png", "png");
  EXPECT_EQ(refusal(with(R"({ "image": "sky.png" })")),
            "sky.png: '.png' is not read as a sky; known are .hdr and .exr");
  folder_.write("bad.hdr", "#?RADIANCE\nnot really");
  EXPECT_EQ(refusal(with(R"({ "image": "bad.hdr" })")), "bad.hdr: is damaged or no hdr image");
  folder_.write("bad.exr", "nothing of the kind");
  EXPECT_EQ(refusal(with(R"({ "image": "bad.exr" })")), "bad.exr: is damaged or no openexr image");
  paint("square.exr", 4, 4, 1, std::vector<float>(16, 1));
  EXPECT_EQ(refusal(with(R"({ "image": "square.exr" })")),
            "square.exr: has 4 x 4 pixels; a sky is equirectangular, twice as wide as high");
  std::vector<float> pixels(8, 1);
  pixels[6] = NAN;
  paint("nan.exr", 4, 2, 1, pixels);
  EXPECT_EQ(refusal(with(R"({ "image": "nan.exr" })")),
            "nan.exr: the pixel in column 3, row 2 has luminance nan; it must be in [0, 1e15] cd/m2");
}

TEST_F(SkyImageFile, NegativePixelsAreDarkAndASunInTheImageIsNamed) {
  std::vector<float> pixels(128 * 64, 1);
  pixels[7] = -2;
  pixels[128 * 10 + 5] = 1e6f;
  paint("sky.exr", 128, 64, 1, pixels);
  const Scene scene = read_scene(with(R"({ "image": "sky.exr" })"));
  EXPECT_NE(all_warnings(scene).find("sky.exr: 3 negative values count as 0"), std::string::npos)
      << all_warnings(scene);
  EXPECT_NE(all_warnings(scene).find("seems to show the sun"), std::string::npos) << all_warnings(scene);
}

TEST_F(SkyImageFile, OfAGreySceneIsGrey) {
  std::vector<float> pixels(3 * 4 * 2, 1);
  pixels[0] = 179;
  paint("sky.exr", 4, 2, 3, pixels);
  Scene scene = read_scene(with(R"({ "image": "sky.exr" })"));
  EXPECT_EQ(scene.channels(), 3);
  make_grey(scene.lights);
  EXPECT_EQ(scene.channels(), 1);
  EXPECT_NEAR(scene.lights.sky->image->pixel(0, 0)[1], 0.2651 + (0.6701 + 0.0648) / 179, 1e-6);
}

}  // namespace
}  // namespace clerestory
