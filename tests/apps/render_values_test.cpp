// clerestory render -o VIEW.exr: the numbers in it, read by OpenImageIO, are those of the result.

#include <cmath>
#include <numbers>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "tests/support/run_program.h"
#include "tests/support/solved_box.h"

namespace clerestory {
namespace {

struct Picture {
  OIIO::ImageSpec spec;
  std::vector<float> value;

  float at(int x, int y, int channel) const {
    return value[static_cast<std::size_t>((y * spec.width + x) * spec.nchannels + channel)];
  }
};

constexpr double field(const Vec3& p) { return 100 + 10 * p.x + 20 * p.y + 30 * p.z; }  // [W/m2]

/// Lit by what is linear over the walls, so that the mean of a pixel is the value in its middle.
class RenderValues : public testing::Test {
 protected:
  RenderValues() { lit_.E = field, result_ = lit_.write(folder_); }

  Picture exr(std::vector<std::string> options) {
    const std::string file = folder_ / "view.exr";
    options.insert(options.begin(), {"render", result_, "-o", file, "--size", "20x10"});
    const ProgramRun run = run_program(options);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    Picture picture;
    if (const auto in = OIIO::ImageInput::open(file)) {
      picture.spec = in->spec();
      picture.value.resize(static_cast<std::size_t>(picture.spec.width * picture.spec.height * picture.spec.nchannels));
      EXPECT_TRUE(in->read_image(0, 0, 0, picture.spec.nchannels, OIIO::TypeDesc::FLOAT, picture.value.data()));
    }
    return picture;
  }
  /// place(x, y): what the middle of a pixel shows, counted from the upper left corner of the picture in [-1, 1].
  void expect_values(const Picture& picture, double of_irradiance, double offset, const auto& place) {
    ASSERT_EQ(picture.spec.width, 20);
    ASSERT_EQ(picture.spec.height, 10);
    ASSERT_EQ(picture.spec.channelnames, (std::vector<std::string>{"Y", "A"}));
    ASSERT_EQ(picture.spec.format, OIIO::TypeDesc::FLOAT);
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 20; ++x) {
        const double value = offset + of_irradiance * field(place((x + 0.5) / 10 - 1, 1 - (y + 0.5) / 5));
        EXPECT_NEAR(double{picture.at(x, y, 0)} / value, 1, 1e-5) << x << ' ' << y;
        EXPECT_NEAR(double{picture.at(x, y, 1)}, 1, 1e-6) << x << ' ' << y;
      }
  }

  SolvedBox lit_;
  TempFolder folder_;
  std::string result_;
};

TEST_F(RenderValues, AreTheResultsOwnFieldAtEveryPixel) {
  // Along +x onto the wall at x = 4, 3 m away; 40 degrees across 20 pixels of 10 down stay on it. To the right is -y.
  const double half = 3 * std::tan(20 * std::numbers::pi / 180);
  const auto on_wall = [&](double across, double up) { return Vec3{4, 1.5 - half * across, 1.25 + half / 2 * up}; };
  const std::vector<std::string> view{"--eye", "1,1.5,1.25", "--target", "4,1.5,1.25", "--fov", "40", "--show"};
  const auto shown = [&](const std::string& what) {
    std::vector<std::string> options = view;
    options.push_back(what);
    return exr(options);
  };
  expect_values(shown("illuminance"), 179, 0, on_wall);  // lm/W
  const double L = 1 / std::numbers::pi;                 // of B = M + rho E
  expect_values(shown("luminance"), 179 * lit_.box.rho * L, 179 * lit_.box.M * L, on_wall);

  // A plan. All of the floor, 4 x 3 m, is in the picture's height or width; what lies beside it is not seen.
  const Picture plan = exr({"--plan", "1.2", "--show", "illuminance"});
  ASSERT_EQ(plan.spec.channelnames, (std::vector<std::string>{"Y", "A"}));
  const auto lux = [](double x, double y) { return 179 * field({x, y, 0}); };
  // The middle of the picture is that of the floor, between four pixels, and a step is the same in x and y.
  const double middle = (plan.at(9, 4, 0) + plan.at(10, 4, 0) + plan.at(9, 5, 0) + plan.at(10, 5, 0)) / 4;
  EXPECT_NEAR(middle / lux(2, 1.5), 1, 1e-5);
  const double across = plan.at(10, 4, 0) - plan.at(9, 4, 0), up = plan.at(9, 4, 0) - plan.at(9, 5, 0);
  EXPECT_NEAR(up / across, 2, 1e-3) << "20 to 10, as the field grows";
  const double metres = across / (179 * 10);  // a pixel
  EXPECT_GE(metres, 0.3) << "3 m in 10 pixels";
  EXPECT_LE(metres, 0.4);
  EXPECT_EQ(plan.at(0, 5, 1), 0) << "beside the floor";
}

TEST_F(RenderValues, ByRaysAreTheClosedFormOfALampAndOfItsShadow) {
  // A black room of 4 x 4 m, 1000 lm 2 m above the middle of its floor, and a plate half way: a shadow of 1 x 2 m.
  folder_.write("floor.obj",
                "v -2 -2 0\nv 2 -2 0\nv 2 2 0\nv -2 2 0\nv -2 -2 3\nv 2 -2 3\nv 2 2 3\nv -2 2 3\n"
                "v -0.25 -0.5 1\nv 0.25 -0.5 1\nv 0.25 0.5 1\nv -0.25 0.5 1\n"
                "o room\nusemtl black\nf 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n"
                "o plate\nusemtl black\nf 9 10 11 12\n");
  const std::string scene = folder_.write("floor.json", R"({ "geometry": [{ "file": "floor.obj" }],
    "materials": { "black": { "reflectance": 0 } },
    "luminaires": [{ "type": "point", "position": [0, 0, 2], "luminous_flux": 1000 }] })");
  result_ = folder_ / "floor.vtp";
  const ProgramRun solved = run_program({"solve", scene, "-o", result_, "--accuracy", "draft", "--no-error"});
  ASSERT_EQ(solved.exit_code, 0) << solved.err;
  const Picture seen = exr({"--plan", "0.5", "--show", "illuminance", "--raytrace", "--samples", "1"});
  // 4 m and a margin of 2 % at either end in 10 pixels.
  const double metres = 4 * 1.04 / 10;
  for (int y = 0; y < 10; ++y)
    for (int x = 5; x < 15; ++x) {
      const double px = (x + 0.5 - 10) * metres, py = (5 - y - 0.5) * metres;
      const bool is_dark = std::abs(px) < 0.5 && std::abs(py) < 1;
      const double exact = is_dark ? 0 : 1000 / (4 * std::numbers::pi) * 2 / std::pow(4 + px * px + py * py, 1.5);
      // The vertices' own light is kept as float, and looked at a little beside them.
      EXPECT_NEAR(double{seen.at(x, y, 0)}, exact, 2e-3 * 20) << px << ' ' << py;
    }
}

}  // namespace
}  // namespace clerestory
