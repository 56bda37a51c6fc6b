// Textures: a material that shows one reflects its mean, whatever the format of model and image.

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/io/paint_image.h"
#include "tests/io/reading.h"

namespace clerestory {
namespace {

/// What 8-bit sRGB shows of the value `v` of 0 to 1. Source: IEC 61966-2-1.
double linear(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

constexpr double kA = 128.0 / 255, kB = 64.0 / 255;
constexpr float a = kA, b = kB;
/// Two pixels.
const std::vector<float> kTwoPixels = {a, b, 0, b, b, b};
const Spectrum kMean{(linear(kA) + linear(kB)) / 2, linear(kB), linear(kB) / 2};

std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string digits;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0u; };
    const unsigned bits = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (const unsigned shift : {18u, 12u, 6u, 0u}) digits += kDigits[bits >> shift & 63];
  }
  digits.resize((bytes.size() * 4 + 2) / 3);
  return digits.append((4 - digits.size() % 4) % 4, '=');
}

class Textures : public ::testing::Test {
 protected:
  void paint(const std::string& name) {
    ASSERT_TRUE(paint_image(folder_ / name, 2, 1, 3, kTwoPixels, OIIO::TypeDesc::UINT8)) << name;
  }
  /// Of the material x of an OBJ file whose MTL says this of it.
  Spectrum of_mtl(const std::string& lines) {
    folder_.write("a.mtl", "newmtl x\n" + lines);
    const Scene scene =
        read_scene(folder_.write("a.obj", "mtllib a.mtl\nusemtl x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    said_ = all_warnings(scene);
    return material(scene, "x").reflectance;
  }
  static std::string gltf(const std::string& material, const std::string& image, const std::string& more = "") {
    return R"({ "asset": { "version": "2.0" }, "nodes": [ { "mesh": 0 } ], "meshes": [ { "primitives": [
        { "attributes": { "POSITION": 0 }, "material": 0 } ] } ],
        "accessors": [ { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" } ],
        "bufferViews": [ { "buffer": 0, "byteLength": 36 })" +
           more + R"( ], "buffers": [ { "byteLength": 36, "uri":
        "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA" })" +
           (more.empty() ? "" : R"(, { "byteLength": 1, "uri": "wood.png" })") +
           R"( ], "materials": [ { "name": "x", )" + material +
           R"( } ], "textures": [ { "source": 0 } ], "images": [ )" + image + " ] }";
  }
  Spectrum of_gltf(const std::string& json) {
    const Scene scene = read_scene(folder_.write("a.gltf", json));
    said_ = all_warnings(scene);
    return material(scene, "x").reflectance;
  }

  TempFolder folder_;
  std::string said_;
};

void expect_near(const Spectrum& x, const Spectrum& y, double tolerance, const std::string& what) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(x[k], y[k], tolerance) << what;
}

TEST_F(Textures, TheirMeanInLinearLightTimesTheColourIsWhatIsReflected) {
  paint("wood.png");
  expect_near(of_mtl("Kd 1 1 1\nmap_Kd wood.png\n"), kMean, 1e-12, "white");
  EXPECT_EQ(said_, "a.obj: 'x' takes the mean of its texture (wood.png)\n");
  expect_near(of_mtl("map_Kd wood.png\n"), kMean, 1e-12, "no Kd");
  expect_near(of_mtl("Kd 0 0 0\nmap_Kd wood.png\n"), kMean, 1e-12, "black, as some write it");
  expect_near(of_mtl("map_Kd wood.png\nKd 0.5 0.5 1\n"), kMean * Spectrum(0.5, 0.5, 1), 1e-12, "a colour of its own");
}

TEST_F(Textures, AreFoundBehindOptionsAndAsWindowsNamesThem) {
  std::filesystem::create_directory(folder_ / "Images");
  paint("Images/old wood.png");
  for (const char* named :
       {"Images/old wood.png", "images\\OLD wood.png", "\"Images\\old wood.png\"", "-s 2 2 1 Images/old wood.png",
        "-s 2 -o 0.5 0.5 -bm 0.2 -clamp on -blendu off -mm 0 1 -imfchan l Images/old wood.png",
        "Images/old wood.png -s 1 1 1", "Images/old wood.png\t \r"}) {
    expect_near(of_mtl("Kd 1\nmap_Kd " + std::string(named) + "\n"), kMean, 1e-12, named);
    EXPECT_NE(said_.find("takes the mean of its texture (old wood.png"), std::string::npos) << said_;
  }
  EXPECT_EQ(of_mtl("Kd 1\nMap_Kd C:\\work\\gone.png\n"), Spectrum(0.5));
  paint("gone.png");
  expect_near(of_mtl("Kd 1\nMap_Kd C:\\work\\gone.png\n"), kMean, 1e-12, "beside the model");
}

TEST_F(Textures, OfEveryFormatAreRead) {
  for (const char* name : {"a.png", "a.bmp", "a.tga", "a.tif"}) {
    paint(name);
    expect_near(of_mtl(std::string("Kd 1\nmap_Kd ") + name + "\n"), kMean, 1e-12, name);
  }
  ASSERT_TRUE(paint_image(folder_ / "deep.png", 2, 1, 3, kTwoPixels, OIIO::TypeDesc::UINT16));
  expect_near(of_mtl("Kd 1\nmap_Kd deep.png\n"), kMean, 1e-4, "16 bits");  // 1/65535 of a value, times a slope of 2.4
  ASSERT_TRUE(paint_image(folder_ / "grey.png", 2, 1, 1, {a, b}, OIIO::TypeDesc::UINT8));
  expect_near(of_mtl("Kd 1\nmap_Kd grey.png\n"), Spectrum(kMean[0]), 1e-12, "grey");
  ASSERT_TRUE(paint_image(folder_ / "even.jpg", 16, 16, 3, std::vector<float>(3 * 256, a), OIIO::TypeDesc::UINT8));
  expect_near(of_mtl("Kd 1\nmap_Kd even.jpg\n"), Spectrum(linear(kA)), 0.005, "jpeg");  // a step of 1/255 or so
  ASSERT_TRUE(paint_image(folder_ / "a.exr", 2, 1, 3, {0.1f, 0.2f, 0.3f, 0.3f, 0.4f, 0.5f}));
  expect_near(of_mtl("Kd 1\nmap_Kd a.exr\n"), {0.2, 0.3, 0.4}, 1e-3, "floats are linear");  // halves have 11 bits
  // Transparent pixels have the colour that is stored for them.
  ASSERT_TRUE(paint_image(folder_ / "clear.png", 2, 1, 4, {a, b, 0, 0, b, b, b, 1}, OIIO::TypeDesc::UINT8));
  expect_near(of_mtl("Kd 1\nmap_Kd clear.png\n"), kMean, 1e-12, "alpha");
}

TEST_F(Textures, ThatCannotBeReadLeaveThePlainColourOrHalfForWhite) {
  paint("wood.png");
  EXPECT_EQ(of_mtl("Kd 1 1 1\nmap_Kd gone.png\n"), Spectrum(0.5));
  EXPECT_NE(said_.find("or 0.5 where that is white: 'x' (gone.png is not there)"), std::string::npos) << said_;
  EXPECT_EQ(of_mtl("map_Kd gone.png\n"), Spectrum(0.5));
  EXPECT_EQ(of_mtl("Kd 0 0 0\nmap_Kd gone.png\n"), Spectrum(0.5));
  EXPECT_EQ(of_mtl("Kd 0.4 0.3 0.2\nmap_Kd gone.png\n"), Spectrum(0.4, 0.3, 0.2));
  EXPECT_NE(said_.find("gone.png is not there"), std::string::npos) << said_;
  const std::string whole = read_text(folder_ / "wood.png");
  folder_.write("cut.png", whole.substr(0, whole.size() / 2));
  folder_.write("text.png", "hello");
  folder_.write("empty.png", "");
  for (const char* name : {"cut.png", "text.png", "empty.png", "."})
    EXPECT_EQ(of_mtl("Kd 1\nmap_Kd " + std::string(name) + "\nnewmtl y\nKd 1\nmap_Kd wood.png\n"), Spectrum(0.5))
        << name;
}

TEST_F(Textures, OfMaterialsThatTheSceneFileDecidesAreNotLookedAt) {
  folder_.write("a.mtl", "newmtl x\nKd 1\nmap_Kd gone.png\n");
  folder_.write("a.obj", "mtllib a.mtl\nusemtl x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Scene scene = read_scene(folder_.write(
      "s.json", R"({ "geometry": [{ "file": "a.obj" }], "materials": { "x*": { "reflectance": 0.3 } } })"));
  EXPECT_EQ(material(scene, "x").reflectance, Spectrum(0.3));
  EXPECT_EQ(all_warnings(scene), "");
}

TEST_F(Textures, OfAMaterialWithoutAnyColourIsHalfWithAWarning) {
  EXPECT_EQ(of_mtl("Ns 10\n"), Spectrum(0.5));
  EXPECT_EQ(said_, "a.obj: nothing describes the material 'x'; reflectance 0.5 is assumed\n");
  EXPECT_EQ(of_gltf(gltf(R"("doubleSided": true)", "")), Spectrum(0.5));
  EXPECT_EQ(said_, "a.gltf: nothing describes the material 'x'; reflectance 0.5 is assumed\n");
  EXPECT_EQ(of_gltf(gltf(R"("pbrMetallicRoughness": { "metallicFactor": 0 })", "")), Spectrum(0.5));
  EXPECT_EQ(of_gltf(gltf(R"("pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1, 1] })", "")), Spectrum(0.99));
}

TEST_F(Textures, OfGltfLieBesideInsideOrInTheTextOfTheFile) {
  paint("old wood.png");
  const std::string base = R"("pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } })";
  expect_near(of_gltf(gltf(base, R"({ "uri": "old%20wood.png" })")), kMean, 1e-12, "beside");
  EXPECT_EQ(said_, "a.gltf: 'x' takes the mean of its texture (old wood.png)\n");
  // As bytes of a buffer, which is a file here as it would be a chunk of a .glb.
  std::filesystem::copy(folder_ / "old wood.png", folder_ / "wood.png");
  const std::string png = read_text(folder_ / "wood.png");
  const std::string view = R"(, { "buffer": 1, "byteLength": )" + std::to_string(png.size()) + " }";
  expect_near(of_gltf(gltf(base, R"({ "bufferView": 1, "mimeType": "image/png", "name": "wood" })", view)), kMean,
              1e-12, "inside");
  EXPECT_EQ(said_, "a.gltf: 'x' takes the mean of its texture (wood)\n");
  // In the text; the factor multiplies.
  expect_near(of_gltf(gltf(R"("pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.25, 0.125, 1],
      "baseColorTexture": { "index": 0 } })",
                           R"({ "uri": "data:image/png;base64,)" + base64(png) + "\" }")),
              kMean * Spectrum(0.5, 0.25, 0.125), 1e-12, "in the text");
  EXPECT_EQ(said_, "a.gltf: 'x' takes the mean of its texture (images[0])\n");
  for (const char* broken : {R"({ "uri": "gone.png" })", R"({ "uri": "data:image/png;base64,AAAA" })", R"({})", R"([])",
                             R"({ "uri": "https://somewhere/gone.png" })", R"({ "bufferView": 7 })"}) {
    EXPECT_EQ(of_gltf(gltf(base, broken)), Spectrum(0.5)) << broken;
    EXPECT_NE(said_.find("textures that cannot be read"), std::string::npos) << said_;
  }
}

TEST_F(Textures, OfGlowTakeTheirShareOfIt) {
  paint("wood.png");
  const Scene scene = read_scene(folder_.write(
      "a.gltf", gltf(R"("emissiveFactor": [1, 1, 1], "emissiveTexture": { "index": 0 })", R"({ "uri": "wood.png" })")));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(material(scene, "x").exitance[k], kMean[k] * 3.14159265358979 / 179, 1e-12);
}

TEST_F(Textures, OfColladaTakeThePlaceOfTheColour) {
  paint("old wood.png");
  const Scene scene = read_scene(folder_.write(
      "a.dae", R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Z_UP</up_axis></asset><library_images><image id="i"><init_from>./old%20wood.png</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON><newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="t"><sampler2D><source>s</source></sampler2D></newparam><technique sid="c"><lambert><diffuse>
<texture texture="t" texcoord="UV"/></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="x"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/>
</vertices><triangles material="mm" count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh>
</geometry></library_geometries><library_visual_scenes><visual_scene id="w"><node id="n"><instance_geometry url="#g">
<bind_material><technique_common><instance_material symbol="mm" target="#m"/></technique_common></bind_material>
</instance_geometry></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>)"));
  expect_near(material(scene, "x").reflectance, kMean, 1e-12, all_warnings(scene));
}

TEST_F(Textures, OfFbxTakeThePlaceOfTheColourBesideAndInside) {
  paint("wood.png");
  const std::string sheet = read_text(std::filesystem::path(CLERESTORY_SOURCE_DIR) / "tests/fuzz/corpus/fbx/sheet.fbx");
  const auto shows = [&](const std::string& video) {
    std::string fbx = sheet;
    fbx.replace(fbx.find("\tMaterial: 1000002"), 0,
                "\tTexture: 1000008, \"Texture::wood\", \"\" {\n\t\tType: \"TextureVideoClip\"\n\t\tVersion: 202\n"
                "\t\tFileName: \"C:\\\\work\\\\Wood.png\"\n\t\tRelativeFilename: \"textures\\\\Wood.png\"\n\t}\n" +
                    video);
    fbx.replace(fbx.find("\tC: \"OO\", 1000003, 0"), 0,
                "\tC: \"OP\", 1000008, 1000002, \"DiffuseColor\"\n" +
                    (video.empty() ? std::string() : "\tC: \"OO\", 1000009, 1000008\n"));
    const Scene scene = read_scene(folder_.write("a.fbx", fbx));
    said_ = all_warnings(scene);
    return material(scene, "paint").reflectance;
  };
  expect_near(shows(""), kMean, 1e-12, "beside");
  EXPECT_NE(said_.find("a.fbx: 'paint' takes the mean of its texture ("), std::string::npos) << said_;
  const std::string png = read_text(folder_ / "wood.png");
  std::filesystem::remove(folder_ / "wood.png");
  EXPECT_EQ(shows(""), Spectrum(0.5)) << said_;
  expect_near(shows("\tVideo: 1000009, \"Video::wood\", \"Clip\" {\n\t\tType: \"Clip\"\n\t\tFileName: "
                    "\"C:\\\\work\\\\Wood.png\"\n"
                    "\t\tRelativeFilename: \"textures\\\\Wood.png\"\n\t\tContent: ,\n\t\t\"" +
                    base64(png) + "\"\n\t}\n"),
              kMean, 1e-12, "inside");
}

}  // namespace
}  // namespace clerestory
