#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/io/reading.h"

namespace clerestory {
namespace {

class Obj : public ::testing::Test {
 protected:
  Scene read(std::string_view obj, const ReadOptions& options = {}) {
    return read_scene(folder_.write("a.obj", obj), options);
  }
  std::string refused(std::string_view obj) { return refusal(folder_.write("a.obj", obj)); }
  TempFolder folder_;
};

constexpr std::string_view kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_F(Obj, NamesOfObjectsAndMaterialsSurvive) {
  const Scene scene = read(kRoomObj);
  EXPECT_EQ(scene.surfaces, (std::vector<std::string>{"floor", "north wall"}));
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].name, "wood");
  EXPECT_EQ(scene.materials[1].name, "wall paint");
}

TEST_F(Obj, PolygonsKeepTheirCornersAndHolesTheirDoubledEdge) {
  const Scene scene =
      read("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 2 0\nv 2 2 0\nv 2 1 0\nf 1 2 3 4 1 5 6 7 8 5\n");
  EXPECT_EQ(scene.polygons.face_count(), 1u);
  EXPECT_EQ(scene.polygons.corner.size(), 10u);
  EXPECT_EQ(scene.polygons.vertices.size(), 8u);
  EXPECT_DOUBLE_EQ(area_vector(scene, 0).z / 2, 15);
}

TEST_F(Obj, NegativeIndicesTexturesNormalsAndContinuedLinesAreUnderstood) {
  const Scene scene =
      read("v 0 0 0\r\nv 1 0 0\r\nv \\\r\n1 1 0\r\nvt 0 0\nvn 0 0 1\nf -3/1/1 -2//1 \\\n -1/1 # here\n");
  ASSERT_EQ(scene.polygons.face_count(), 1u);
  EXPECT_EQ(scene.polygons.vertices[2], (Vec3{1, 1, 0}));
}

TEST_F(Obj, AMillionMetresAwayNoDigitIsLost) {
  const Scene scene =
      read("v 1000000.000000001 5000000.25 0\nv 1000001.0000000012 5000000 0\nv 1000000 5000001 0\nf 1 2 3\n");
  EXPECT_EQ(scene.polygons.vertices[0], (Vec3{1000000.000000001, 5000000.25, 0}));
  EXPECT_EQ(scene.polygons.vertices[1].x, 1000001.0000000012);
}

TEST_F(Obj, UnitAndUpOfTheCommandLineApply) {
  const Scene scene =
      read("v 0 0 0\nv 1000 0 0\nv 0 2000 0\nv 0 0 3000\nf 1 2 3\nf 1 2 4\n", {.unit = "mm", .up = "y", .sky = {}});
  EXPECT_EQ(extent(scene).upper, (Vec3{1, 0, 2}));
  EXPECT_EQ(extent(scene).lower, (Vec3{0, -3, 0}));  // the file's z comes towards the viewer
  EXPECT_GT(area_vector(read("v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n", {.unit = {}, .up = "y", .sky = {}}), 0).z, 0);
}

TEST_F(Obj, MtlColoursAreReflectancesAndKeIsARadiance) {
  folder_.write("my materials.mtl",
                "newmtl red wall\nKd 0.6 0.1 0.1\nnewmtl lamp\nKd 0.2\nKe 3 2 1\nnewmtl pane\nKd 1 1 1\nd 0.1\n");
  const Scene scene = read(
      "mtllib my materials.mtl\nusemtl red wall\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl lamp\nf 1 2 3\nusemtl "
      "pane\nf 1 2 3\n");
  EXPECT_EQ(material(scene, "red wall").reflectance, Spectrum(0.6, 0.1, 0.1));
  EXPECT_EQ(material(scene, "lamp").reflectance, Spectrum(0.2));
  EXPECT_EQ(material(scene, "lamp").exitance, std::numbers::pi * Spectrum(3, 2, 1));
  EXPECT_EQ(material(scene, "pane").kind, MaterialKind::glass);
  EXPECT_EQ(material(scene, "pane").transmittance, Spectrum(0.9));
}

TEST_F(Obj, KeBeyondWhatAResultCanHoldIsRefused) {
  folder_.write("a.mtl", "newmtl lamp\nKe 1e300 0 0\n");
  EXPECT_EQ(refusal(folder_.write("a.obj", "mtllib a.mtl\nusemtl lamp\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")),
            "a.mtl:2: '1e300' is not a number from 0 to 1e+12");
}

TEST_F(Obj, WhiteIsTakenAsNearlyWhiteWithOneWarning) {
  folder_.write("a.mtl", "newmtl a\nKd 1 1 1\nnewmtl b\nKd 1 0 0\n");
  const Scene scene = read("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n");
  EXPECT_EQ(material(scene, "a").reflectance, Spectrum(0.99));
  EXPECT_EQ(material(scene, "b").reflectance, Spectrum(0.99, 0, 0));
  EXPECT_EQ(all_warnings(scene), "a.obj: reflectance 1 or more is taken as 0.99 for 'a', 'b'\n");
}

TEST_F(Obj, FacesWithoutAMaterialReflectHalfWithAWarning) {
  const Scene scene = read(kTriangle);
  EXPECT_EQ(material(scene, "default").reflectance, Spectrum(0.5));
  EXPECT_EQ(scene.surfaces[0], "a");
  EXPECT_EQ(all_warnings(scene), "a.obj: nothing describes the material 'default'; reflectance 0.5 is assumed\n");
}

TEST_F(Obj, AMissingMaterialFileIsAWarning) {
  const Scene scene = read("mtllib gone.mtl\nusemtl x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_NE(all_warnings(scene).find("gone.mtl' is missing"), std::string::npos);
}

TEST_F(Obj, MaterialFilesNamedOnWindowsAreFound) {
  std::filesystem::create_directory(folder_ / "Mats");
  folder_.write("Mats/Paint.mtl", "newmtl x\nKd 0.3\n");
  folder_.write("my house.mtl", "newmtl x\nKd 0.3\n");
  folder_.write("a.mtl", "newmtl y\nKd 0.3\n");
  for (const char* named : {"Mats\\Paint.mtl", "mats/paint.MTL", "MY HOUSE.MTL", "\"my house.mtl\"", "'my house.mtl'",
                            "C:\\Users\\me\\My Models\\my house.mtl", "/somewhere/else/my house.mtl",
                            "a.mtl \"my house.mtl\"", "a.mtl mats\\paint.mtl\t", ".\\Mats\\Paint.mtl"}) {
    const Scene scene = read("mtllib " + std::string(named) + "\r\nusemtl x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(material(scene, "x").reflectance, Spectrum(0.3)) << named;
    EXPECT_EQ(all_warnings(scene), "") << named;
  }
}

TEST_F(Obj, LinesMayEndInCrAloneAndTheFileBeginWithAMark) {
  folder_.write("a.mtl", "\xef\xbb\xbfnewmtl x\rKd 0.3\r");
  const Scene scene = read("\xef\xbb\xbfmtllib a.mtl\rusemtl x\rv 0 0 0\rv 1 0 \\\r0\rv 0 1 0\rf 1 2 3\r");
  EXPECT_EQ(material(scene, "x").reflectance, Spectrum(0.3));
  EXPECT_EQ(scene.polygons.face_count(), 1u);
}

TEST_F(Obj, LinesPointsAndUnusedVerticesAreLeftOut) {
  const Scene scene = read("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\np 1\nf 2 3 4\n");
  EXPECT_EQ(scene.polygons.vertices.size(), 3u);
}

TEST_F(Obj, SizesThatLookLikeMillimetresAreWarnedOf) {
  const std::string_view in_mm = "v 0 0 0\nv 5000 0 0\nv 0 4000 0\nf 1 2 3\n";
  EXPECT_NE(all_warnings(read(in_mm)).find("was it drawn in millimetres? Then say \"unit\": \"mm\" (--unit mm)"),
            std::string::npos);
  EXPECT_EQ(all_warnings(read(in_mm, {.unit = "mm", .up = {}, .sky = {}})).find("millimetres"), std::string::npos);
  EXPECT_NE(all_warnings(read(kTriangle, {.unit = "mm", .up = {}, .sky = {}})).find("larger than assumed"),
            std::string::npos);
}

TEST_F(Obj, NamesThatAreNotUtf8AreMadeSo) {
  EXPECT_EQ(read("o caf\xe9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").surfaces[0], "caf?");
  EXPECT_EQ(read("o caf\xc3\xa9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").surfaces[0], "caf\xc3\xa9");
}

TEST_F(Obj, BadNumbersAndIndicesNameTheirLine) {
  EXPECT_EQ(refused("v 0 0 0\nv 1 abc 3\n"), "a.obj:2: vertex 2: 'abc' is not a number; 'v' needs x y z");
  EXPECT_EQ(refused("v 0 0\n"), "a.obj:1: vertex 1: '' is not a number; 'v' needs x y z");
  EXPECT_EQ(refused("v 0 nan 0\n"), "a.obj:1: vertex 1: y = nan is outside [-1e12, 1e12]");
  EXPECT_EQ(refused("v 0 0 inf\n"), "a.obj:1: vertex 1: z = inf is outside [-1e12, 1e12]");
  EXPECT_EQ(refused("v 1e400 0 0\n"), "a.obj:1: vertex 1: x = 1e400 is outside [-1e12, 1e12]");
  EXPECT_EQ(refused("v 2e12 0 0\n"), "a.obj:1: vertex 1: x = 2e12 is outside [-1e12, 1e12]");
  EXPECT_EQ(refused("v 0 0 0\nf 1 2 3\n"), "a.obj:2: a face uses vertex 2, but 1 vertices stand before it");
  EXPECT_EQ(refused("v 0 0 0\nf 0 1 1\n"), "a.obj:2: a face uses vertex 0, but 1 vertices stand before it");
  EXPECT_EQ(refused("v 0 0 0\nf -1 -2 1\n"), "a.obj:2: a face uses vertex -2, but 1 vertices stand before it");
  EXPECT_EQ(refused("v 0 0 0\nf 1 x 1\n"),
            "a.obj:2: 'x' is not a corner of a face; expected v, v/vt, v//vn or v/vt/vn");
}

TEST_F(Obj, FilesWithoutAFaceAreRefused) {
  EXPECT_NE(refused("v 0 0 0\nl 1 1\n").find("a.obj: has no faces"), std::string::npos);
  EXPECT_NE(refused("once upon a time\n").find("a.obj: has no faces"), std::string::npos);
}

TEST_F(Obj, GlossOfTheMaterialFileIsTakenWhereItIsAskedFor) {
  folder_.write("a.mtl",
                "newmtl tile\nKd 0.4 0.4 0.4\nKs 0.1 0.2 0.3\nNs 80\nillum 2\n"
                "newmtl chalk\nKd 0.4 0.4 0.4\nKs 0.5 0.5 0.5\nNs 10\nillum 1\n"
                "newmtl white\nKd 0.9 0.9 0.9\nKs 0.6 0.6 0.6\nNs 1e9\n");
  const auto file = folder_.write("a.obj",
                                  "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl tile\nf 1 2 3\nusemtl chalk\n"
                                  "f 1 3 2\nusemtl white\nf 2 3 1\n");
  const Scene diffuse = read_scene(file);
  for (const Material& m : diffuse.materials) EXPECT_FALSE(m.is_glossy());
  ASSERT_EQ(diffuse.left_out.size(), 1u);
  EXPECT_NE(diffuse.left_out[0].find("'tile' (31 %), 'white' (40 %)"), std::string::npos) << diffuse.left_out[0];
  const Scene glossy = read_scene(file, {.gloss = "model"});
  EXPECT_EQ(material(glossy, "tile").gloss->specular, Spectrum(0.1, 0.2, 0.3));
  EXPECT_EQ(material(glossy, "tile").gloss->exponent, 80);
  EXPECT_EQ(material(glossy, "tile").reflectance, Spectrum(0.4));
  EXPECT_FALSE(material(glossy, "chalk").is_glossy());
  const Material white = material(glossy, "white");  // more than there is, in proportion
  EXPECT_NEAR((white.reflectance + white.gloss->specular).max(), 0.99, 1e-12);
  EXPECT_NEAR(white.gloss->specular[0] / white.reflectance[0], 0.6 / 0.9, 1e-12);
  EXPECT_EQ(white.gloss->exponent, 1e6);
  EXPECT_TRUE(std::ranges::any_of(glossy.warnings, [](const std::string& line) {
    return line.find("brought down to it in proportion for 'white' (1.5)") != std::string::npos;
  }));
  folder_.write("a.mtl", "newmtl tile\nKs red\nNs shiny\nKd 0.4 0.4 0.4\n");
  EXPECT_EQ(read_scene(file).materials[0].reflectance, Spectrum(0.4));
}

TEST_F(Obj, ReflectancesOfTheMaterialFileMustBeNumbers) {
  folder_.write("a.mtl", "newmtl a\nKd 0.5 red 0.5\n");
  EXPECT_EQ(refused("mtllib a.mtl\n"), "a.mtl:2: 'red' is not a number from 0 to 1e+12");
  folder_.write("a.mtl", "newmtl a\nKd -1 0 0\n");
  EXPECT_EQ(refused("mtllib a.mtl\n"), "a.mtl:2: '-1' is not a number from 0 to 1e+12");
}

}  // namespace
}  // namespace clerestory
