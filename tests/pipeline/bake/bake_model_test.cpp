#include "pipeline/bake/bake_model.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include <gtest/gtest.h>

#include "io/read_scene.h"
#include "tests/support/flat_result.h"
#include "tests/support/glb_file.h"

namespace clerestory {
namespace {

/// A square of 1 m on the ground (y up) with normals and texture coordinates, which a node shows where it is, and
/// another, a child of a turned and mirrored one, elsewhere. With a camera and a picture of one pixel beside it.
std::string write_two_nodes(const TempFolder& folder) {
  const float data[] = {0, 0, 0, 1, 0, 0, 1, 0,    -1, 0, 0, -1,  // POSITION
                        0, 1, 0, 0, 1, 0, 0, 1,    0,  0, 1, 0,   // NORMAL
                        0, 0, 1, 0, 1, 1, 0, 0.75F};              // TEXCOORD_0
  const std::uint16_t corners[] = {0, 1, 2, 0, 2, 3};
  std::string bytes(sizeof data + sizeof corners, '\0');
  std::memcpy(bytes.data(), data, sizeof data);
  std::memcpy(bytes.data() + sizeof data, corners, sizeof corners);
  folder.write("squares.bin", bytes);
  folder.write("wood.png", std::string("\x89PNG\r\n\x1a\nand so on"));
  return folder.write("squares.gltf", R"({ "asset": { "version": "2.0" }, "scene": 0,
    "scenes": [ { "nodes": [0, 1] } ],
    "nodes": [ { "name": "here", "mesh": 0, "extras": { "room": 7 } },
               { "name": "turned", "rotation": [0, 0.70710678118, 0, 0.70710678118], "translation": [4, 0.5, 0],
                 "scale": [2, 1, -2], "children": [2] },
               { "name": "there", "mesh": 0, "camera": 0 } ],
    "cameras": [ { "type": "perspective", "name": "eye", "perspective": { "yfov": 1, "znear": 0.1 } } ],
    "meshes": [ { "name": "square", "primitives": [
      { "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 }, "indices": 3, "material": 0 } ] } ],
    "materials": [ { "name": "wood", "doubleSided": true, "pbrMetallicRoughness": {
      "baseColorFactor": [0.5, 0.5, 0.5, 1], "baseColorTexture": { "index": 0 } } } ],
    "textures": [ { "source": 0, "sampler": 0 } ], "samplers": [ { "wrapS": 33071 } ], "images": [ { "uri": "wood.png" } ],
    "accessors": [ { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" },
                   { "bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 4, "type": "VEC3" },
                   { "bufferView": 0, "byteOffset": 96, "componentType": 5126, "count": 4, "type": "VEC2" },
                   { "bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR" } ],
    "bufferViews": [ { "buffer": 0, "byteLength": 128 }, { "buffer": 0, "byteOffset": 128, "byteLength": 12 } ],
    "buffers": [ { "byteLength": 140, "uri": "squares.bin" } ] })");
}

/// Light on all faces of a scene, on the side they front: 10 + 2 x + 3 y + 5 z at each of its vertices.
double light_at(const Vec3& p) { return 10 + 2 * p.x + 3 * p.y + 5 * p.z; }
WrittenResult lit(const Scene& scene) {
  WrittenResult r = empty_result();
  r.surfaces = scene.surfaces;
  r.materials = scene.materials;
  for (std::size_t f = 0; f < scene.polygons.face_count(); ++f) {
    const auto first = static_cast<std::uint32_t>(r.points.size());
    for (std::uint32_t c = scene.polygons.face_begin[f]; c < scene.polygons.face_begin[f + 1]; ++c) {
      const Vec3 p = scene.polygons.vertices[scene.polygons.corner[c]];
      r.points.push_back(p);
      r.of_points["irradiance"].value.push_back(static_cast<float>(light_at(p)));
      r.of_points["radiosity"].value.push_back(0.1F);
      r.of_points["illuminance"].value.push_back(static_cast<float>(179 * light_at(p)));
    }
    r.triangles.push_back({first, first + 1, first + 2});
    r.surface.push_back(scene.polygons.surface[f].value);
    r.material.push_back(scene.polygons.material[f].value);
  }
  return r;
}

class BakeModel : public ::testing::Test {
 protected:
  GlbFile bake(const std::string& scene_file) {
    const Scene scene = read_scene(scene_file);
    const BakedScene baked = bake_scene(lit(scene), scene);
    EXPECT_EQ(baked.missing_share, 0);
    AtomicFile file(folder_ / "out.glb");
    left_out_ = write_model_glb(file, baked.models, baked.names, 0.01);
    file.commit();
    return GlbFile(folder_ / "out.glb");
  }
  /// Faces of both files lie in the same places, in the same order.
  void expect_same_polygons(const std::string& scene_file) {
    const Scene before = read_scene(scene_file), after = read_scene(folder_ / "out.glb");
    ASSERT_EQ(before.polygons.corner.size(), after.polygons.corner.size());
    for (std::size_t c = 0; c < before.polygons.corner.size(); ++c)
      EXPECT_LT(length(before.polygons.vertices[before.polygons.corner[c]] -
                       after.polygons.vertices[after.polygons.corner[c]]),
                1e-6)
          << c;
  }
  TempFolder folder_;
  std::vector<std::string> left_out_;
};

TEST_F(BakeModel, NodesInstancesAndTextureCoordinatesOfAGltfSurvive) {
  const std::string file = write_two_nodes(folder_);
  const GlbFile glb = bake(file);
  EXPECT_TRUE(left_out_.empty());
  EXPECT_EQ(glb.json["scenes"][0]["nodes"].size(), 2u);
  EXPECT_EQ(glb.node("here")["extras"]["room"], 7);
  const nlohmann::json& turned = glb.node("turned");
  EXPECT_EQ(turned["translation"], nlohmann::json({4, 0.5, 0}));
  EXPECT_EQ(turned["scale"], nlohmann::json({2, 1, -2}));
  EXPECT_NEAR(turned["rotation"][1].get<double>(), 0.70710678118, 1e-9);
  ASSERT_EQ(turned["children"].size(), 1u);
  EXPECT_EQ(glb.json["nodes"][turned["children"][0].get<std::size_t>()]["name"], "there");
  EXPECT_EQ(glb.json["cameras"][glb.node("there")["camera"].get<std::size_t>()]["name"], "eye");
  expect_same_polygons(file);

  ASSERT_EQ(glb.json["meshes"].size(), 2u) << "each instance has light of its own";
  const Vec3 here[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const Vec3 there[4] = {{4, 0, 0.5}, {4, 2, 0.5}, {6, 2, 0.5}, {6, 0, 0.5}};  // scaled, turned, moved, z up
  for (const char* name : {"here", "there"}) {
    EXPECT_EQ(glb.json["meshes"][glb.node(name)["mesh"].get<std::size_t>()]["name"], "square");
    const nlohmann::json& attributes = glb.primitive(name)["attributes"];
    EXPECT_EQ(glb.numbers(attributes["TEXCOORD_0"]), (std::vector<double>{0, 0, 1, 0, 1, 1, 0, 0.75}));
    EXPECT_EQ(glb.numbers(attributes["NORMAL"]), (std::vector<double>{0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0}));
    const std::vector<double> lux = glb.numbers(attributes["_ILLUMINANCE"]),
                              colour = glb.numbers(attributes["COLOR_0"]);
    ASSERT_EQ(lux.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      const double exact = light_at(name[0] == 'h' ? here[i] : there[i]);
      EXPECT_NEAR(lux[i] / (179 * exact), 1, 1e-5);
      EXPECT_NEAR(colour[3 * i], 0.01 * exact, 1e-6);
    }
  }
  const nlohmann::json& material = glb.json["materials"][0];
  EXPECT_EQ(glb.json["materials"].size(), 1u);
  EXPECT_EQ(material["name"], "wood");
  EXPECT_FALSE(material.value("doubleSided", false));
  EXPECT_TRUE(material["extensions"].contains("KHR_materials_unlit"));
  EXPECT_EQ(material["pbrMetallicRoughness"]["baseColorFactor"], nlohmann::json({0.5, 0.5, 0.5, 1.0}));
  const nlohmann::json& texture =
      glb.json["textures"][material["pbrMetallicRoughness"]["baseColorTexture"]["index"].get<std::size_t>()];
  EXPECT_EQ(glb.json["samplers"][texture["sampler"].get<std::size_t>()]["wrapS"], 33071);
  const nlohmann::json& image = glb.json["images"][texture["source"].get<std::size_t>()];
  EXPECT_EQ(image["mimeType"], "image/png");
  const nlohmann::json& view = glb.json["bufferViews"][image["bufferView"].get<std::size_t>()];
  EXPECT_EQ(glb.binary.substr(view["byteOffset"].get<std::size_t>(), view["byteLength"].get<std::size_t>()),
            read_text(folder_ / "wood.png"));
}

TEST_F(BakeModel, APictureThatIsGoneIsNamed) {
  const std::string file = write_two_nodes(folder_);
  std::filesystem::remove(folder_ / "wood.png");
  const GlbFile glb = bake(file);
  EXPECT_EQ(left_out_, std::vector<std::string>{"wood.png"});
  EXPECT_FALSE(glb.json["materials"][0]["pbrMetallicRoughness"].contains("baseColorTexture"));
}

TEST_F(BakeModel, ModelsOfASceneStandUnderNodesOfTheirOwn) {
  write_two_nodes(folder_);
  folder_.write("floor.obj",
                "v 0 0 0\nv 500 0 0\nv 500 500 0\nv 0 500 0\no floor\nf 1 2 3\nf 1 3 4\nv 10 10 80\nv 20 10 80\nv 20 "
                "20 80\no table\nf 5 6 7\n");
  const std::string scene = folder_.write("both.json", R"({ "geometry": [
    { "file": "floor.obj", "unit": "cm" },
    { "file": "squares.gltf", "transform": [0, -1, 0, 20, 1, 0, 0, 3, 0, 0, 1, 1, 0, 0, 0, 1] } ],
    "sky": { "model": "uniform", "horizontal_illuminance": 1000 } })");
  const GlbFile glb = bake(scene);
  EXPECT_EQ(glb.json["scenes"][0]["nodes"].size(), 2u);
  EXPECT_EQ(glb.node("floor.obj")["children"].size(), 2u);
  EXPECT_EQ(glb.node("squares.gltf")["children"].size(), 2u);
  EXPECT_EQ(glb.numbers(glb.primitive("floor")["attributes"]["POSITION"]),
            (std::vector<double>{0, 0, 0, 5, 0, 0, 5, 0, -5, 0, 0, -5}));
  expect_same_polygons(scene);
}

TEST_F(BakeModel, AShearedGltfIsWrittenAsItStandsInTheScene) {
  write_two_nodes(folder_);
  const std::string scene = folder_.write("sheared.json", R"({ "geometry": [
    { "file": "squares.gltf", "transform": [1, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] } ],
    "sky": { "model": "uniform", "horizontal_illuminance": 1000 } })");
  const GlbFile glb = bake(scene);
  EXPECT_EQ(glb.json["nodes"].size(), 2u);
  expect_same_polygons(scene);
}

TEST_F(BakeModel, OneMeshHasAllModelsWithTheirSurfaces) {
  write_two_nodes(folder_);
  folder_.write("floor.obj", "v 0 0 0\nv 5 0 0\nv 5 5 0\no floor\nf 1 2 3\n");
  const Scene scene = read_scene(folder_.write("both.json", R"({ "geometry": [
    { "file": "floor.obj" }, { "file": "squares.gltf", "transform": [1, 0, 0, 9, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] } ],
    "sky": { "model": "uniform", "horizontal_illuminance": 1000 } })"));
  const NamedMesh all = as_one_mesh(bake_scene(lit(scene), scene));
  ASSERT_EQ(all.mesh.position.size(), 11u);
  ASSERT_EQ(all.mesh.triangles.size(), 5u);
  for (std::size_t i = 0; i < 11; ++i) {
    const auto is_there = [&](const Vec3& p) { return length(all.mesh.position[i] - p) < 1e-9; };
    EXPECT_TRUE(std::ranges::any_of(scene.polygons.vertices, is_there)) << i;
    EXPECT_NEAR(all.mesh.illuminance[i] / (179 * light_at(all.mesh.position[i])), 1, 1e-5);
  }
  std::vector<std::string> names;
  for (const std::uint32_t s : all.mesh.surface) names.push_back(all.names.surfaces[s]);
  EXPECT_EQ(names, (std::vector<std::string>{"floor", "here", "here", "there", "there"}));
}

}  // namespace
}  // namespace clerestory
