#include "io/bake/atlas_files.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "solver/model/exposure.h"
#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

/// 8 x 4 texels: lux is 1000 y + x, what is shown grows to the right in red and down in green.
LightmapAtlas small_atlas(int colours) {
  LightmapAtlas atlas;
  atlas.width = 8, atlas.height = 4, atlas.texels_per_metre = 10, atlas.used = 0.75;
  atlas.channels = LightmapAtlas::kShown + colours;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) {
      atlas.value.push_back(static_cast<float>(1000 * y + x) + 0.125f);
      for (int k = 0; k < colours; ++k) atlas.value.push_back(k == 0 ? 0.1f * x : k == 1 ? 0.2f * y : 3);
    }
  AtlasChart& chart = atlas.charts.emplace_back();
  chart.x = 1, chart.y = 1, chart.width = 6, chart.height = 2;
  chart.normal = {0, 0, 1}, chart.origin = {3, 4, 5}, chart.u = {0.1, 0, 0}, chart.v = {0, 0.1, 0}, chart.area = 0.05;
  return atlas;
}

template <class Write>
std::string written(const std::string& file, const Write& write) {
  AtomicFile out(file);
  write(out);
  out.commit();
  return file;
}

template <class Number>
std::vector<Number> pixels_of(const std::string& file, OIIO::TypeDesc type, OIIO::ImageSpec& spec) {
  const auto in = OIIO::ImageInput::open(file);
  if (!in) return {};
  spec = in->spec();
  std::vector<Number> pixels(static_cast<std::size_t>(spec.width * spec.height * spec.nchannels));
  EXPECT_TRUE(in->read_image(0, 0, 0, spec.nchannels, type, pixels.data()));
  return pixels;
}

TEST(AtlasFiles, TheExrHoldsTheLuxOfEachTexelInOneChannel) {
  const TempFolder folder;
  const LightmapAtlas atlas = small_atlas(3);
  OIIO::ImageSpec spec;
  const auto pixels = pixels_of<float>(written(folder / "a.exr", [&](AtomicFile& out) { write_atlas_exr(out, atlas); }),
                                       OIIO::TypeDesc::FLOAT, spec);
  ASSERT_EQ(pixels.size(), 32u);
  EXPECT_EQ(spec.width, 8);
  EXPECT_EQ(spec.channelnames, std::vector<std::string>{"Y"});
  for (std::size_t i = 0; i < pixels.size(); ++i) EXPECT_EQ(pixels[i], atlas.at(i, LightmapAtlas::kIlluminance));
}

TEST(AtlasFiles, ThePngShowsTheColoursExposedAndClipped) {
  const TempFolder folder;
  for (const int colours : {1, 3}) {
    const LightmapAtlas atlas = small_atlas(colours);
    OIIO::ImageSpec spec;
    const auto pixels =
        pixels_of<std::uint8_t>(written(folder / "a.png", [&](AtomicFile& out) { write_atlas_png(out, atlas, 2); }),
                                OIIO::TypeDesc::UINT8, spec);
    ASSERT_EQ(pixels.size(), 96u);
    const std::size_t texel = 3 * 8 + 2;  // x = 2, y = 3
    EXPECT_EQ(pixels[3 * texel], srgb_byte(0.4));
    EXPECT_EQ(pixels[3 * texel + 1], colours == 1 ? srgb_byte(0.4) : 255);
    EXPECT_EQ(pixels[3 * texel + 2], colours == 1 ? srgb_byte(0.4) : 255);
  }
}

TEST(AtlasFiles, TheJsonTellsWhereEachChartIs) {
  const TempFolder folder;
  WrittenResult result;
  result.surfaces = {"floor \"A\""};
  const auto json = nlohmann::json::parse(
      read_text(written(folder / "a.json", [&](AtomicFile& out) { write_atlas_json(out, small_atlas(1), result); })));
  EXPECT_EQ(json["width"], 8);
  EXPECT_EQ(json["height"], 4);
  EXPECT_EQ(json["texels_per_metre"], 10);
  EXPECT_EQ(json["used"], 0.75);
  ASSERT_EQ(json["charts"].size(), 1u);
  const auto& chart = json["charts"][0];
  EXPECT_EQ(chart["surface"], "floor \"A\"");
  EXPECT_EQ(chart["rectangle"], (nlohmann::json{1, 1, 6, 2}));
  EXPECT_EQ(chart["origin"], (nlohmann::json{3, 4, 5}));
  EXPECT_EQ(chart["u"], (nlohmann::json{0.1, 0, 0}));
}

}  // namespace
}  // namespace clerestory
