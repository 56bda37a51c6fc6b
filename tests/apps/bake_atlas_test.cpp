// clerestory bake with textures, from the outside.

#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/glb_file.h"
#include "tests/support/run_program.h"
#include "tests/support/solved_box.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

/// A closed room in which all is equally bright.
class BakeAtlas : public testing::Test {
 protected:
  ProgramRun bake(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"bake", result_});
    return run_program(arguments);
  }
  bool exists(const char* name) { return std::filesystem::exists(folder_ / name); }

  TempFolder folder_;
  std::string result_ = SolvedBox{}.write(folder_);
};

TEST_F(BakeAtlas, AGlbShowsItsLightByThePictureBesideIt) {
  const ProgramRun run = bake({"-o", folder_ / "my room.glb", "--texels-per-metre", "10"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("lookups: 100 % of the surface within 1 %"), run.out.npos) << run.out;
  EXPECT_TRUE(exists("my room.exr") && exists("my room.png"));
  const GlbFile glb(folder_ / "my room.glb");
  EXPECT_EQ(glb.json["images"][0]["uri"], "my%20room.png");
  EXPECT_EQ(glb.json["samplers"][0]["wrapS"], 33071) << "clamped";
  for (const Json& material : glb.json["materials"]) {
    const Json& texture = material["pbrMetallicRoughness"]["baseColorTexture"];
    EXPECT_EQ(texture["texCoord"], 1);
    EXPECT_TRUE(material["extensions"].contains("KHR_materials_unlit"));
  }
  for (const Json& mesh : glb.json["meshes"])
    for (const Json& primitive : mesh["primitives"]) {
      const Json& attributes = primitive["attributes"];
      EXPECT_FALSE(attributes.contains("COLOR_0")) << "light would count twice";
      EXPECT_TRUE(attributes.contains("_ILLUMINANCE") && attributes.contains("_IRRADIANCE"));
      for (const double x : glb.numbers(attributes["TEXCOORD_1"])) EXPECT_TRUE(x >= 0 && x <= 1) << x;
    }
}

TEST_F(BakeAtlas, TheExtensionTakesThePlaceOfBaseColourAndUnlit) {
  const ProgramRun run = bake({"-o", folder_ / "ext.glb", "--texels-per-metre", "10", "--lightmap-extension"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const GlbFile glb(folder_ / "ext.glb");
  EXPECT_EQ(glb.json["extensionsUsed"], Json({"MOZ_lightmap"}));
  for (const Json& material : glb.json["materials"]) {
    EXPECT_FALSE(material["pbrMetallicRoughness"].contains("baseColorTexture"));
    const Json& lightmap = material["extensions"]["MOZ_lightmap"];
    EXPECT_EQ(lightmap["texCoord"], 1);
    EXPECT_EQ(lightmap["intensity"], 1);
    EXPECT_TRUE(lightmap.contains("index"));
  }
}

TEST_F(BakeAtlas, TheTextureAloneHasItsChartsBesideItEvenOfAFileCalledExr) {
  const ProgramRun run = bake({"-o", folder_ / ".exr"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(read_text(folder_ / ".exr").starts_with("\x76\x2f\x31\x01"));
  const Json json = Json::parse(read_text(folder_ / ".json"));
  EXPECT_EQ(json["texels_per_metre"], 20);
  EXPECT_GE(json["used"], 0.75);
  double area = 0;
  for (const Json& chart : json["charts"]) area += chart["area"].get<double>();
  EXPECT_NEAR(area, BoxScene{}.area(), 1e-4);
}

TEST_F(BakeAtlas, WhatCannotBeIsRefusedBeforeTheWork) {
  for (const char* number : {"0", "-1", "nan", "inf", "many"})
    EXPECT_EQ(bake({"-o", folder_ / "no.glb", "--texels-per-metre", number}).exit_code, 2) << number;
  EXPECT_EQ(bake({"-o", folder_ / "no.ply", "--texels-per-metre", "10"}).exit_code, 2);
  EXPECT_EQ(bake({"-o", folder_ / "no.glb", "--lightmap-extension"}).exit_code, 2);
  EXPECT_EQ(bake({"-o", folder_ / "no.glb", "--texels-per-metre", "10", "--detail", "model"}).exit_code, 2);

  const ProgramRun large = bake({"-o", folder_ / "no.glb", "--texels-per-metre", "100000"});
  EXPECT_EQ(large.exit_code, 3);
  EXPECT_NE(large.err.find("room.vtp: 100000 texels per metre need a picture larger than 16384 x 16384"),
            large.err.npos)
      << large.err;
  EXPECT_NE(large.err.find("fits."), large.err.npos);

  std::filesystem::create_directory(folder_ / "taken.png");
  const ProgramRun taken = bake({"-o", folder_ / "taken.glb", "--texels-per-metre", "10"});
  EXPECT_EQ(taken.exit_code, 3);
  EXPECT_NE(taken.err.find("taken.png"), taken.err.npos) << taken.err;
  EXPECT_FALSE(exists("taken.glb") || exists("taken.exr") || exists("no.glb") || exists("no.exr") || exists("no.png"));
}

TEST_F(BakeAtlas, IsTheSameForAnyNumberOfThreads) {
  SolvedBox varied;
  varied.E = [](const Vec3& p) { return 100 + 10 * p.x + 20 * p.y + 30 * p.z; };
  varied.write(folder_);
  ASSERT_EQ(bake({"-o", folder_ / "one.glb", "--texels-per-metre", "15", "--threads", "1"}).exit_code, 0);
  ASSERT_EQ(bake({"-o", folder_ / "two.glb", "--texels-per-metre", "15", "--threads", "3"}).exit_code, 0);
  EXPECT_GT(read_text(folder_ / "one.exr").size(), 1000u);
  EXPECT_TRUE(exists("one.png"));
  EXPECT_EQ(read_text(folder_ / "one.exr"), read_text(folder_ / "two.exr"));
  EXPECT_EQ(read_text(folder_ / "one.png"), read_text(folder_ / "two.png"));
  EXPECT_EQ(GlbFile(folder_ / "one.glb").binary, GlbFile(folder_ / "two.glb").binary);
}

}  // namespace
}  // namespace clerestory
