#include "io/chart/chart.h"

#include <string>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "io/chart/dot_matrix.h"
#include "io/picture/encode.h"

namespace clerestory {
namespace {

constexpr Ink kRed{200, 0, 0};

/// Three bytes a pixel of a 40 x 20 chart.
std::vector<unsigned char> pixels_of(const Chart& chart) {
  std::string bytes = png_of(chart);
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  const auto in = OIIO::ImageInput::create("png");
  OIIO::ImageSpec spec;
  std::vector<unsigned char> pixels(3 * 40 * 20);
  EXPECT_TRUE(in && in->set_ioproxy(&memory) && in->open("chart.png", spec));
  EXPECT_EQ(spec.width, 40);
  EXPECT_EQ(spec.height, 20);
  EXPECT_EQ(spec.nchannels, 3);
  EXPECT_TRUE(in->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, pixels.data()));
  return pixels;
}

/// Of a line of that width from (10, 10) to (30, 10): as much ink as its area.
double ink_of(const std::vector<unsigned char>& pixels) {
  double ink = 0;
  for (std::size_t i = 0; i < pixels.size(); i += 3) ink += (255 - pixels[i + 1]) / 255.0;
  return ink;
}

TEST(Png, HasTheInkOfItsShapes) {
  // A line has round ends: width times length and a circle.
  const auto line = pixels_of({40, 20, {Chart::Line{10, 10, 30, 10, 4, {0, 0, 0}}}});
  EXPECT_NEAR(ink_of(line), 4 * 20 + 3.14159 * 4, 2);  // edges are straight ramps, 2 % off
  const auto disc = pixels_of({40, 20, {Chart::Disc{20, 10, 6, kRed}}});
  EXPECT_NEAR(ink_of(disc), 3.14159 * 36, 2);
  const std::size_t middle = 3 * (10 * 40 + 20);
  EXPECT_EQ(disc[middle], 200);
  EXPECT_EQ(disc[middle + 1], 0);
  EXPECT_EQ(disc[0], 255);
}

TEST(Png, WordsStandOnTheirLineAndEndWhereTheyShould) {
  const auto right = pixels_of({40, 20, {Chart::Words{38, 15, 10, Chart::Anchor::end, "LL", {0, 0, 0}}}});
  std::size_t leftmost = 40, lowest = 0;
  for (std::size_t y = 0; y < 20; ++y)
    for (std::size_t x = 0; x < 40; ++x)
      if (right[3 * (40 * y + x)] < 128) leftmost = std::min(leftmost, x), lowest = std::max(lowest, y);
  EXPECT_EQ(leftmost, 26u) << "two letters of six dots before 38";
  EXPECT_EQ(lowest, 14u);
}

TEST(DotMatrix, EveryCharacterHasItsOwnStrokes) {
  std::vector<std::string> seen;
  for (char c = '!'; c <= '~'; ++c) {
    std::string dots;
    for (const DotStroke& s : strokes_of(c))
      for (const double v : {s.x1, s.y1, s.x2, s.y2}) dots += std::to_string(v) + " ";
    EXPECT_FALSE(dots.empty()) << c;
    EXPECT_EQ(std::count(seen.begin(), seen.end(), dots), 0) << c;
    seen.push_back(dots);
  }
  EXPECT_TRUE(strokes_of(' ').empty());
  EXPECT_EQ(strokes_of('\n').size(), strokes_of('?').size());
}

TEST(Svg, HoldsAllShapesAndNoSignsOfItsOwnInWords) {
  const std::string svg = svg_of({40,
                                  20,
                                  {Chart::Line{1, 2, 3, 4, 5, kRed}, Chart::Disc{1, 2, 3, kRed},
                                   Chart::Words{1, 2, 3, Chart::Anchor::middle, "a < b", kRed}}});
  for (const char* words :
       {"<svg xmlns", "<line x1=\"1.0\"", "<circle cx=\"1.0\"", "#c80000", ">a &lt; b</text>", "</svg>"})
    EXPECT_NE(svg.find(words), std::string::npos) << words;
}

TEST(ExrBytes, HoldTheVeryFloats) {
  const std::vector<float> value = {1e-7f, 20'000.5f, 0, 3, -1.5f, 1e30f};
  std::string bytes = exr_bytes(3, 1, {"Y", "share"}, value);
  const auto in = OIIO::ImageInput::create("exr");
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  OIIO::ImageSpec spec;
  ASSERT_TRUE(in && in->set_ioproxy(&memory) && in->open("a.exr", spec));
  EXPECT_EQ(spec.channelnames, (std::vector<std::string>{"Y", "share"}));
  std::vector<float> read(value.size());
  ASSERT_TRUE(in->read_image(0, 0, 0, 2, OIIO::TypeDesc::FLOAT, read.data()));
  EXPECT_EQ(read, value);
}

}  // namespace
}  // namespace clerestory
