// Scales, legends and pixels of views.

#include "io/picture/paint_view.h"

#include <cmath>

#include <gtest/gtest.h>

#include "io/picture/colour_map.h"
#include "solver/model/exposure.h"

namespace clerestory {
namespace {

TEST(TicksOf, AreRoundNumbersAndBothEnds) {
  EXPECT_EQ(ticks_of({0, 1000, false}, 10),
            (std::vector<double>{0, 100, 200, 300, 400, 500, 600, 700, 800, 900, 1000}));
  EXPECT_EQ(ticks_of({10, 1000, true}, 8), (std::vector<double>{10, 20, 50, 100, 200, 500, 1000}));
  EXPECT_EQ(ticks_of({1, 1e6, true}, 8), (std::vector<double>{1, 10, 100, 1000, 1e4, 1e5, 1e6}));
  EXPECT_EQ(ticks_of({3, 97, false}, 5), (std::vector<double>{3, 20, 40, 60, 80, 97}));
}

TEST(ScaleAround, LeavesOutAFewExtremesAndHasRoundEnds) {
  std::vector<float> values;
  for (int i = 0; i < 1000; ++i) values.push_back(100 + 0.7f * static_cast<float>(i));  // 100 to 800
  values.push_back(1e9f);
  const ValueScale linear = scale_around(values, false), log = scale_around(values, true);
  EXPECT_EQ(linear.low, 0);
  EXPECT_EQ(linear.high, 800);
  EXPECT_EQ(log.low, 100);
  EXPECT_EQ(log.high, 1000);
  EXPECT_LT(scale_around({}, false).low, scale_around({}, false).high);
  EXPECT_LT(scale_around({5, 5, 5}, false).low, scale_around({5, 5, 5}, false).high);
  EXPECT_LT(scale_around({0, 0}, true).low, scale_around({0, 0}, true).high);
}

ViewImage one_row(const std::vector<float>& value, const std::vector<float>& seen) {
  return {static_cast<int>(value.size()), 1, 1, value, seen};
}

TEST(TrueColours, AreTheScreensCurveOfExposedRadiosity) {
  const auto L = static_cast<float>(0.18 / std::numbers::pi);
  Pixels pixels = true_colours(one_row({L, 0, 0, 9}, {1, 0, 0.5f, 1}), 1, 1);
  EXPECT_EQ(*pixels.at(0, 0), srgb_byte(0.18));
  EXPECT_EQ(*pixels.at(1, 0), 255) << "the background";
  EXPECT_EQ(*pixels.at(2, 0), srgb_byte(0.5));
  EXPECT_EQ(*pixels.at(3, 0), 255);
}

TEST(FalseColours, AreThoseOfTheScale) {
  const ValueScale scale{0, 100, false};
  Pixels pixels = false_colours(one_row({50, 25, 0}, {1, 0.5f, 0}), scale);  // 25 over half of the pixel: 50 there
  const Ink expected = false_colour(50, scale);
  EXPECT_EQ(*pixels.at(0, 0), expected.r);
  EXPECT_EQ(pixels.at(0, 0)[2], expected.b);
  EXPECT_NEAR(*pixels.at(1, 0), (expected.r + 255) / 2, 1);
  EXPECT_EQ(*pixels.at(2, 0), 255) << "nothing is seen there";
  EXPECT_NEAR(expected.g, 255 * viridis(0.5)[1], 1);
}

TEST(WithLegend, KeepsThePictureAndShowsTheScaleFromHighToLow) {
  Pixels picture(300, 400, 77);
  const ValueScale scale{0, 100, false};
  Pixels both = with_legend(picture, scale, "illuminance", "[lux]");
  ASSERT_GT(both.width, 350);
  ASSERT_EQ(both.height, 400);
  for (int y = 0; y < 400; ++y)
    for (int x = 0; x < 300; ++x) ASSERT_EQ(*both.at(x, y), 77);
  // Down the middle of the bar: yellow on top, dark blue below.
  const int x = 300 + 18;
  EXPECT_NEAR(both.at(x, 49)[0], false_colour(100, scale).r, 3);
  EXPECT_LT(both.at(x, 375)[1], 20);
}

TEST(DrawStroke, CoversAPixelOnceWhereItsPartsMeet) {
  Pixels straight(40, 40, 255), parts(40, 40, 255);
  draw_stroke({{5, 20.3}, {35, 20.3}}, 1.5, {0, 0, 0}, straight);
  draw_stroke({{5, 20.3}, {10, 20.3}, {10.5, 20.3}, {20, 20.3}, {35, 20.3}}, 1.5, {0, 0, 0}, parts);
  EXPECT_EQ(straight.rgb, parts.rgb);
}

TEST(DrawLines, PutsTheNumberOfALineOnIt) {
  const ValueScale scale{0, 1000, false};
  const auto inked = [&](double length) {
    Pixels pixels(600, 300, 255);
    draw_lines({{200, {{{20, 150}, {20 + length, 150}}}}}, &scale, pixels);
    int count = 0;
    for (int y = 145; y < 156; ++y)
      for (int x = 0; x < 600; ++x) count += y != 149 && y != 150 && pixels.at(x, y)[1] < 200 ? 1 : 0;
    return count;
  };
  EXPECT_GT(inked(500), 50) << "a label";
  EXPECT_LT(inked(10), 30) << "no room for one";
}

}  // namespace
}  // namespace clerestory
