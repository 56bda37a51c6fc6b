#include <cstring>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/io/reading.h"
#include "tests/support/luminaires.h"

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;

std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {  // all of ours have a multiple of three bytes
    const auto byte = [&](std::size_t k) { return static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k])); };
    const unsigned bits = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (const unsigned shift : {18u, 12u, 6u, 0u}) out += kDigits[bits >> shift & 63];
  }
  return out;
}

/// A square of 1 m on the ground (y up), corners counter-clockwise from above, as two triangles.
std::string square_bytes() {
  const float points[12] = {0, 0, 0, 1, 0, 0, 1, 0, -1, 0, 0, -1};
  const std::uint16_t corners[6] = {0, 1, 2, 0, 2, 3};
  std::string bytes(60, '\0');
  std::memcpy(bytes.data(), points, 48);
  std::memcpy(bytes.data() + 48, corners, 12);
  return bytes;
}

/// A file of that square; `nodes` and further root members are given.
std::string gltf(const std::string& nodes, const std::string& more = "", const std::string& buffer = "",
                 const std::string& mode = "4") {
  const std::string uri = buffer.empty() ? "data:application/octet-stream;base64," + base64(square_bytes()) : buffer;
  return R"({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [ { "nodes": [0] } ], "nodes": [)" + nodes +
         R"(], "meshes": [ { "name": "square", "primitives": [ { "attributes": { "POSITION": 0 }, "indices": 1, "material": 0,
         "mode": )" +
         mode + R"( } ] } ],
         "accessors": [ { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" },
                        { "bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR" } ],
         "bufferViews": [ { "buffer": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 12 } ],
         "buffers": [ { "byteLength": 60, "uri": ")" +
         uri + "\" } ]" +
         (more.empty()
              ? R"(, "materials": [ { "name": "paint", "pbrMetallicRoughness": { "baseColorFactor": [0.8, 0.6, 0.4, 1] } } ])"
              : ", " + more) +
         " }";
}

class Gltf : public ::testing::Test {
 protected:
  Scene read(const std::string& json) { return read_scene(folder_.write("a.gltf", json)); }
  std::string refused(const std::string& json) { return refusal(folder_.write("a.gltf", json)); }
  TempFolder folder_;
};

TEST_F(Gltf, YUpMetresAreBelievedWhateverIsSaidOfThem) {
  folder_.write("a.gltf", gltf(R"({ "name": "floor", "mesh": 0 })"));
  const Scene scene =
      read_scene(folder_.write("s.json", R"({ "geometry": [ { "file": "a.gltf", "unit": "mm", "up": "z" } ] })"));
  EXPECT_EQ(extent(scene).upper, (Vec3{1, 1, 0}));
  EXPECT_GT(area_vector(scene, 0).z, 0);
  EXPECT_EQ(scene.surfaces[0], "floor");
  EXPECT_EQ(material(scene, "paint").reflectance, Spectrum(0.8, 0.6, 0.4));
  EXPECT_NE(all_warnings(scene).find("the file itself says metres"), std::string::npos);
}

TEST_F(Gltf, EachNodeShowsItsMeshOnceWithAllTransformsAboveIt) {
  const Scene scene =
      read(gltf(R"({ "name": "all", "scale": [2, 2, 2], "children": [1, 2] }, { "name": "chair", "mesh": 0 },
                                   { "name": "chair", "mesh": 0, "translation": [5, 1, 0] })"));
  EXPECT_EQ(scene.surfaces, (std::vector<std::string>{"chair", "chair 2"}));
  EXPECT_EQ(scene.polygons.face_count(), 4u);
  EXPECT_EQ(extent(scene).lower, (Vec3{0, 0, 0}));
  EXPECT_EQ(extent(scene).upper, (Vec3{12, 2, 2}));
}

TEST_F(Gltf, MirroredNodesKeepTheirFronts) {
  const Scene scene = read(gltf(R"({ "mesh": 0, "scale": [-1, 1, 1] })"));
  EXPECT_GT(area_vector(scene, 0).z, 0);
  EXPECT_EQ(extent(scene).lower.x, -1);
}

TEST_F(Gltf, MatricesAndQuaternionsTurnTheSameWay) {
  // A quarter turn about y: x goes to -z, and in the scene to +y.
  const Scene by_matrix = read(gltf(R"({ "mesh": 0, "matrix": [0,0,-1,0, 0,1,0,0, 1,0,0,0, 3,0,0,1] })"));
  const Scene by_quaternion = read(
      gltf(R"({ "mesh": 0, "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476], "translation": [3, 0, 0] })"));
  ASSERT_EQ(by_matrix.polygons.vertices.size(), by_quaternion.polygons.vertices.size());
  for (std::size_t v = 0; v < 4; ++v) {
    EXPECT_LT(length(by_matrix.polygons.vertices[v] - by_quaternion.polygons.vertices[v]), 1e-15);
  }
  EXPECT_EQ(by_matrix.polygons.vertices[1], (Vec3{3, 1, 0}));
}

TEST_F(Gltf, NodesAMillionMetresAwayKeepMillimetres) {
  const Scene scene = read(gltf(R"({ "mesh": 0, "translation": [1000000.001, 0, -5000000.002] })"));
  EXPECT_EQ(scene.polygons.vertices[0], (Vec3{1000000.001, 5000000.002, 0}));
}

TEST_F(Gltf, EmissionIsALuminance) {
  const Scene scene = read(gltf(R"({ "mesh": 0 })", R"("materials": [ { "name": "lamp", "emissiveFactor": [1, 0.5, 0],
      "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 1790 } } } ])"));
  // 1790 cd/m2 is 10 W/(m2 sr) at 179 lm/W, and pi times that leaves a diffuse surface.
  EXPECT_NEAR(material(scene, "lamp").exitance[0], 10 * kPi, 1e-12);
  EXPECT_NEAR(material(scene, "lamp").exitance[1], 5 * kPi, 1e-12);
  EXPECT_EQ(material(scene, "lamp").reflectance, Spectrum(0.5));  // glTF's default is white, which nothing is
}

TEST_F(Gltf, LightsStandWhereTheirNodesAreAndOneLightMayStandTwice) {
  const Scene scene = read(gltf(
      R"({ "mesh": 0, "children": [1, 2, 3, 4] },
         { "name": "a", "translation": [0, 2, 0], "extensions": { "KHR_lights_punctual": { "light": 0 } } },
         { "name": "b", "translation": [1, 2, 0], "extensions": { "KHR_lights_punctual": { "light": 0 } } },
         { "name": "spot", "translation": [0, 3, 0], "rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476],
           "extensions": { "KHR_lights_punctual": { "light": 1 } } },
         { "name": "sun", "extensions": { "KHR_lights_punctual": { "light": 2 } } })",
      R"("materials": [ { "name": "paint" } ], "extensions": { "KHR_lights_punctual": { "lights": [
           { "type": "point", "intensity": 179, "color": [1, 0.5, 0.25] },
           { "type": "spot", "intensity": 358, "spot": { "innerConeAngle": 0.2, "outerConeAngle": 0.5 } },
           { "type": "directional", "intensity": 1790 } ] } })"));
  ASSERT_EQ(scene.lights.luminaires.size(), 3u);
  const Luminaire &a = scene.lights.luminaires[0], &b = scene.lights.luminaires[1], &spot = scene.lights.luminaires[2];
  EXPECT_EQ(a.name, "a");
  EXPECT_EQ(a.position, (Vec3{0, 0, 2}));
  EXPECT_EQ(b.position, (Vec3{1, 0, 2}));
  EXPECT_NEAR(test::as_point(a).power[0], 4 * kPi, 1e-12);  // 1 W/sr all around
  EXPECT_NEAR(test::as_point(a).power[2], kPi, 1e-12);
  EXPECT_LT(length(test::as_spot(spot).direction - Vec3{0, 0, -1}), 1e-15);
  EXPECT_DOUBLE_EQ(test::as_spot(spot).intensity[0], 2);
  EXPECT_EQ(test::as_spot(spot).outer_angle, 0.5);
  ASSERT_EQ(scene.lights.suns.size(), 1u);
  EXPECT_EQ(scene.lights.suns[0].direction, (Vec3{0, -1, 0}));  // it shines along -z of the node: to +y of the scene
  EXPECT_DOUBLE_EQ(scene.lights.suns[0].normal_irradiance[0], 10);
}

TEST_F(Gltf, LightProfilesShineAlongTheirNodes) {
  // 100 cd straight ahead, nothing at a right angle; to H = 0 more than to H = 180.
  folder_.write("lamp.ies",
                "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 3 1 2 0 0 0\n1 1 9\n0 45 90\n0 90 180\n"
                "100 90 0\n100 50 0\n100 10 0\n");
  const std::string lights = R"("materials": [ { "name": "paint" } ], "extensions": { "EXT_lights_ies": { "lights": [
      { "uri": "lamp.ies" }, { "uri": "no.ies" }, {} ] } })";
  const auto node = [](const std::string& members) {
    return R"({ "mesh": 0, "children": [1] }, { "name": "lamp", "translation": [1, 2, 3], "rotation":
      [-0.7071067811865476, 0, 0, 0.7071067811865476], "extensions": { "EXT_lights_ies": { )" +
           members + " } } }";
  };
  const Scene scene = read(gltf(node(R"("light": 0, "multiplier": 2, "color": [1, 0.5, 0])"), lights));
  ASSERT_EQ(scene.lights.luminaires.size(), 1u);
  const WebLuminaire& lamp = test::as_web(scene.lights.luminaires[0]);
  EXPECT_EQ(scene.lights.luminaires[0].name, "lamp");
  EXPECT_LT(length(scene.lights.luminaires[0].position - Vec3{1, -3, 2}), 1e-12);
  // The node's -z points down, its x stays.
  EXPECT_LT(length(lamp.axes.z - Vec3{0, 0, 1}), 1e-12);
  EXPECT_LT(length(lamp.axes.x - Vec3{1, 0, 0}), 1e-12);
  EXPECT_LT(length(lamp.axes.y - Vec3{0, 1, 0}), 1e-12);
  EXPECT_DOUBLE_EQ(lamp.scale[0], 2 / 179.0);
  EXPECT_DOUBLE_EQ(lamp.scale[1], 1 / 179.0);
  EXPECT_NEAR(candela_towards(*lamp.web, normalized({1, 0, -1})), 90, 1e-5);
  EXPECT_NE(refused(gltf(node(R"("light": 1)"), lights)).find("EXT_lights_ies.lights[1]: "), std::string::npos);
  EXPECT_NE(refused(gltf(node(R"("light": 2)"), lights)).find("has neither a uri nor a bufferView"), std::string::npos);
  EXPECT_NE(refused(gltf(node(R"("light": 3)"), lights)).find("uses light 3, which is not there"), std::string::npos);
  folder_.write("lamp.ies", "TILT=NONE\n1 -1 1 3 x\n");
  EXPECT_EQ(refused(gltf(node(R"("light": 0)"), lights)),
            "a.gltf: EXT_lights_ies.lights[0]:2: 'x' is not a number; expected the number of horizontal angles");
}

TEST_F(Gltf, LightBeyondWhatAResultCanHoldIsRefused) {
  EXPECT_EQ(refused(gltf(R"({ "mesh": 0 })", R"("materials": [ { "name": "lamp", "emissiveFactor": [1, 1, 1],
      "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 1e300 } } } ])")),
            "a.gltf: materials[0]: emissiveFactor x emissiveStrength = [1e+300, 1e+300, 1e+300] is outside [0, 1e+15]");
  const std::string lamp =
      gltf(R"({ "mesh": 0, "translation": [2, 0, 0], "extensions": { "KHR_lights_punctual": { "light": 0 } } })",
           R"("materials": [ { "name": "paint" } ],
         "extensions": { "KHR_lights_punctual": { "lights": [ { "type": "point", "intensity": 1e300 } ] } })");
  EXPECT_EQ(refused(lamp), "a.gltf: lights[0]: color x intensity = [1e+300, 1e+300, 1e+300] is outside [0, 1e+15]");
}

TEST_F(Gltf, BlendedAndTransmittingMaterialsAreGlass) {
  const Scene blended = read(gltf(R"({ "mesh": 0 })", R"("materials": [ { "name": "pane", "alphaMode": "BLEND",
      "pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1, 0.25] } } ])"));
  EXPECT_EQ(material(blended, "pane").kind, MaterialKind::glass);
  EXPECT_EQ(material(blended, "pane").transmittance, Spectrum(0.75));
  const Scene passing = read(gltf(R"({ "mesh": 0 })", R"("materials": [ { "name": "pane",
      "pbrMetallicRoughness": { "baseColorFactor": [0.9, 1, 0.8, 1] },
      "extensions": { "KHR_materials_transmission": { "transmissionFactor": 1 } } } ])"));
  EXPECT_EQ(material(passing, "pane").transmittance, Spectrum(0.9, 1, 0.8));
}

TEST_F(Gltf, GlossOfMetalsAndOthersIsTakenWhereItIsAskedForAndElseTold) {
  const auto file = folder_.write("a.gltf", gltf(R"({ "mesh": 0 })", R"("materials": [ { "name": "brass",
      "pbrMetallicRoughness": { "baseColorFactor": [0.8, 0.6, 0.4, 1], "metallicFactor": 0.75, "roughnessFactor": 0.3 } } ])"));
  const Scene diffuse = read_scene(file);
  EXPECT_FALSE(material(diffuse, "brass").gloss);
  EXPECT_EQ(material(diffuse, "brass").reflectance, Spectrum(0.8, 0.6, 0.4));
  ASSERT_EQ(diffuse.left_out.size(), 1u);
  EXPECT_EQ(diffuse.left_out[0],
            "a.gltf: gloss that the model gives to 'brass' (75 %), of the light that each reflects: it is taken as "
            "diffuse; --gloss model follows it");
  const Scene glossy = read_scene(file, {.gloss = "model"});
  const Material brass = material(glossy, "brass");
  ASSERT_TRUE(brass.is_glossy());
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(brass.reflectance[k], 0.25 * (0.8 - 0.2 * k), 1e-12);
    EXPECT_NEAR(brass.gloss->specular[k], 0.01 + 0.75 * (0.8 - 0.2 * k), 1e-12);
  }
  EXPECT_EQ(brass.gloss->roughness, 0.3);
  EXPECT_TRUE(glossy.left_out.empty());
  const Scene silent = read_scene(folder_.write("a.gltf", gltf(R"({ "mesh": 0 })", R"("materials": [ { "name": "paint",
      "pbrMetallicRoughness": { "baseColorFactor": [0.8, 0.6, 0.4, 1] } } ])")),
                                  {.gloss = "model"});
  EXPECT_FALSE(material(silent, "paint").is_glossy());
}

TEST_F(Gltf, StripsAndFansAreTrianglesWoundAlike) {
  const Scene strip = read(gltf(R"({ "mesh": 0 })", "", "", "5"));
  EXPECT_EQ(strip.polygons.face_count(), 4u);
  const Scene fan = read(gltf(R"({ "mesh": 0 })", "", "", "6"));
  EXPECT_EQ(fan.polygons.face_count(), 4u);
  EXPECT_GT(area_vector(fan, 0).z, 0);
  EXPECT_NE(refused(gltf(R"({ "mesh": 0 })", "", "", "1")).find("has no faces"), std::string::npos);  // lines
}

TEST_F(Gltf, BuffersMayLieBesideTheFile) {
  folder_.write("square 1.bin", square_bytes());
  EXPECT_EQ(read(gltf(R"({ "mesh": 0 })", "", "square%201.bin")).polygons.face_count(), 2u);
}

TEST_F(Gltf, BrokenFilesNameTheElement) {
  const std::string square = R"({ "mesh": 0 })";
  EXPECT_EQ(refused(gltf(square, "", "gone.bin")), "a.gltf: buffers[0]: " + folder_ / "gone.bin" + ": no such file");
  EXPECT_EQ(refused(gltf(square, "", "data:application/octet-stream;base64,AAAA")),
            "a.gltf: buffers[0] has 3 of 60 bytes; the file is cut off");
  EXPECT_EQ(refused(gltf(square, "", "https://example.org/a.bin")),
            "a.gltf: buffers[0] 'https://example.org/a.bin' is on the net; only files beside the model are read");
  EXPECT_EQ(refused(gltf(R"({ "mesh": 4 })")), "a.gltf: meshes[4] is used, but there are 1 meshes");
  EXPECT_EQ(refused(gltf(R"({ "mesh": 0, "children": [0] })")),
            "a.gltf: nodes[0] has two parents, or holds itself; nodes must form a tree");
  EXPECT_EQ(refused(gltf(R"({ "mesh": 0, "scale": [1, 2] })")), "a.gltf: nodes[0].scale must be 3 numbers");
  EXPECT_EQ(refused(gltf(R"({ "mesh": 0, "scale": [1e200, 1, 1] })")),
            "a.gltf: vertex 1 (from 0) of 'square' is at (1e+200, 0, 0), outside [-1e12, 1e12]; is the file damaged, "
            "or drawn far from its origin?");
  EXPECT_EQ(refused(R"({ "asset": { "version": "1.0" } })"), "a.gltf: is glTF version '1.0'; only version 2 is read");
  EXPECT_EQ(refused("{}"), "a.gltf: is JSON, but not glTF: it has no \"asset\"");
  EXPECT_TRUE(refused("{ \"asset\": ").starts_with("a.gltf:1:"));
  std::string wild = gltf(square);
  wild.replace(wild.find("\"count\": 6"), 10, "\"count\": 4000000000");
  EXPECT_EQ(refused(wild),
            "a.gltf: accessors[1] needs 4000000000 elements, more than its bufferView of 12 bytes holds");
  std::string out_of_range = square_bytes();
  out_of_range[48] = 9;
  EXPECT_EQ(refused(gltf(square, "", "data:;base64," + base64(out_of_range))),
            "a.gltf: face 1 of 'square' uses vertex 9 (from 0), but there are 4");
  std::string not_a_number = square_bytes();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(not_a_number.data() + 12, &nan, 4);
  EXPECT_EQ(refused(gltf(square, "", "data:;base64," + base64(not_a_number))),
            "a.gltf: vertex 1 (from 0) of 'square' is at (nan, nan, nan), outside [-1e12, 1e12]; is the file damaged, "
            "or drawn far from its origin?");
}

TEST_F(Gltf, CutOffBinariesSaySo) {
  EXPECT_EQ(refusal(folder_.write("a.glb", "glTF")),
            "a.glb: is cut off: a .glb file has at least 20 bytes, this one 4");
  EXPECT_EQ(refusal(folder_.write("a.glb", std::string("glTF\2\0\0\0\xff\0\0\0", 12) + std::string(20, ' '))),
            "a.glb: is cut off: it has 32 of 255 bytes");
  EXPECT_EQ(refusal(folder_.write("a.glb", "solid")),
            "a.glb: does not start like a .glb file; is it damaged, or another format?");
}

}  // namespace
}  // namespace clerestory
