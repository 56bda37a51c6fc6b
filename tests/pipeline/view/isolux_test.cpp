// Where lines of equal illuminance are drawn.

#include <cmath>

#include <gtest/gtest.h>

#include "io/picture/iso_lines.h"
#include "io/picture/paint_view.h"
#include "solver/view/place_camera.h"
#include "solver/view/trace_view.h"
#include "solver/view/visible_line.h"
#include "tests/support/small_result.h"

namespace clerestory {
namespace {

/// A black floor of 10 x 10 m in squares of 5 cm, 2 m below a point luminaire of 1000 cd: E = I h / (h2 + r2)^(3/2).
constexpr double kHeight = 2, kIntensity = 1000, kSide = 10;
double lux_at(double r) { return kIntensity * kHeight / std::pow(kHeight * kHeight + r * r, 1.5); }
double radius_of(double lux) { return std::sqrt(std::pow(kIntensity * kHeight / lux, 2.0 / 3) - kHeight * kHeight); }

WrittenResult lit_floor() {
  constexpr int n = 200;
  WrittenResult r = empty_result();
  std::vector<float>& lux = r.of_points["illuminance"].value;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const Vec3 p{kSide * i / n - kSide / 2, kSide * j / n - kSide / 2, 0};
      r.points.push_back(p);
      lux.push_back(static_cast<float>(lux_at(std::hypot(p.x, p.y))));
      if (i == n || j == n) continue;
      const auto a = static_cast<std::uint32_t>(j * (n + 1) + i), b = a + n + 1;
      r.triangles.push_back({a, a + 1, b + 1}), r.triangles.push_back({a, b + 1, b});
    }
  return r;
}

TEST(Isolux, OfAPointLuminaireIsDrawnWithinHalfAPixelOfItsClosedForm) {
  const WrittenResult r = lit_floor();
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < r.triangles.size(); ++i) all.push_back(i);
  const ViewScene scene(r, {1, r.of_points.at("illuminance").value, false}, all);
  const Camera camera = *camera_of_cut({2, 1}, r.points, r.triangles, 1000, 1000);
  const double per_metre = 1000 / (2 * camera.half_width);
  EXPECT_NEAR(per_metre, 96.15, 0.01);

  for (const double level : {20.0, 50.0, 100.0, 200.0}) {
    const double expected = per_metre * radius_of(level);
    const std::vector<double> levels{level};
    LineOnPicture line{level, {}};
    for (const IsoLine& iso : iso_lines(r.points, facing_triangles(camera, r.points, scene.triangles()),
                                        r.of_points.at("illuminance").value, levels))
      for (const auto& part : visible_parts(camera, scene.surfaces(), iso.points)) {
        auto& corners = line.parts.emplace_back();
        for (const OnPicture& at : part) {
          corners.push_back({at.x, at.y});
          EXPECT_NEAR(std::hypot(at.x - 500, at.y - 500), expected, 0.1) << level;  // of linear triangles
        }
      }
    ASSERT_EQ(line.parts.size(), 1u);

    // As pixels: the mean place of the ink across the line, in each row and column that crosses it at a right angle.
    Pixels pixels(1000, 1000, 255);
    const ValueScale scale{0, level, false};  // its line is black, and its label below the least length
    for (const auto& part : line.parts) draw_stroke(part, 1.5, contrast_to(false_colour(level, scale)), pixels);
    for (const bool across : {true, false})
      for (const int sign : {-1, 1}) {
        double ink = 0, place = 0;
        for (int k = -6; k <= 6; ++k) {
          const int at = static_cast<int>(500 + sign * expected) + k;
          const double share = 255 - *(across ? pixels.at(at, 500) : pixels.at(500, at));
          ink += share, place += share * (at + 0.5);
        }
        ASSERT_GT(ink, 255) << level;
        EXPECT_NEAR(place / ink, 500 + sign * expected, 0.5) << level;
      }
  }
}

}  // namespace
}  // namespace clerestory
