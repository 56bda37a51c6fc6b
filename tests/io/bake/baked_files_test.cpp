#include "io/bake/baked_files.h"

#include <cmath>
#include <cstring>
#include <sstream>

#include <gtest/gtest.h>

#include "io/read_scene.h"
#include "solver/model/bake_points.h"
#include "solver/model/exposure.h"
#include "tests/support/flat_result.h"
#include "tests/support/glb_file.h"

namespace clerestory {
namespace {

/// Floor and wall that glows, in colour: 5 x 5 points each.
WrittenResult two_surfaces(const Vec3& at = {}) {
  WrittenResult r = empty_result(3);
  r.surfaces = {"floor", "wall ä", "unused"};
  r.materials.resize(2);
  r.materials[0].reflectance = {0.25, 0.5, 0.75};
  r.materials[1].name = "panel";
  add_rectangle(
      r, at, {4, 0, 0}, {0, 3, 0}, 4, [&](const Vec3& p) { return 1 + p.x - at.x + 2 * (p.y - at.y); }, 0, 0);
  add_rectangle(
      r, at, {0, 3, 0}, {0, 0, 2}, 4, [](const Vec3& p) { return 2 + std::sin(p.z); }, 1, 1);
  for (std::size_t i = 75; i < 150; ++i) r.of_points["radiosity"].value[i] += 7;
  return r;
}

constexpr double kExposure = 0.11;  // clips some of both

class BakedFiles : public ::testing::Test {
 protected:
  template <class Write>
  std::string written(const char* name, const Write& write) {
    AtomicFile file(folder_ / name);
    write(file);
    file.commit();
    return folder_ / name;
  }
  /// The geometry, as our own readers understand it.
  static void expect_same_geometry(const Scene& scene, const BakedMesh& mesh, double within) {
    ASSERT_EQ(scene.polygons.face_count(), mesh.triangles.size());
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 p = scene.polygons.vertices[scene.polygons.corner[scene.polygons.face_begin[f] + k]];
        EXPECT_LT(length(p - mesh.position[mesh.triangles[f][k]]), within) << f;
      }
  }
  TempFolder folder_;
};

TEST_F(BakedFiles, PlyHasTheseProperties) {
  const WrittenResult r = two_surfaces();
  const BakedMesh mesh = baked_points(r);
  const std::string file = written("a.ply", [&](AtomicFile& f) { write_baked_ply(f, mesh, kExposure); });
  const std::string bytes = read_text(file);
  const std::string head = bytes.substr(0, bytes.find("end_header\n") + 11);
  std::string properties;
  std::istringstream lines(head);
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("comment")) properties += line + "|";
  EXPECT_EQ(properties,
            "ply|format binary_little_endian 1.0|element vertex 50|property float x|property float y|property float z|"
            "property float nx|property float ny|property float nz|property uchar red|property uchar green|"
            "property uchar blue|property float illuminance|property float irradiance_0|property float irradiance_1|"
            "property float irradiance_2|element face 64|property list uchar int vertex_indices|end_header|");
  constexpr std::size_t kRow = 6 * 4 + 3 + 4 * 4;
  ASSERT_EQ(bytes.size(), head.size() + 50 * kRow + 64 * 13);
  for (std::size_t i = 0; i < 50; ++i) {
    const char* row = bytes.data() + head.size() + i * kRow;
    float normal[3], light[4];
    std::memcpy(normal, row + 12, 12), std::memcpy(light, row + 27, 16);
    EXPECT_EQ(normal[2], i < 25 ? 1 : 0);
    EXPECT_EQ(light[0], r.of_points.at("illuminance").value[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(light[k + 1], r.of_points.at("irradiance").value[3 * i + k]);
      const double shown = mesh.shown[i][static_cast<int>(k)] * kExposure;
      const auto colour = static_cast<unsigned char>(row[24 + k]);
      EXPECT_NEAR(colour, 255 * srgb_encoded(shown), 0.5 + 1e-9) << i;  // half a step
    }
  }
  expect_same_geometry(read_scene(file), mesh, 1e-6);
}

TEST_F(BakedFiles, PlyFarFromTheOriginSaysWhereItIs) {
  const BakedMesh mesh = baked_points(two_surfaces({2e6, -1e6, 100}));
  const std::string file = written("a.ply", [&](AtomicFile& f) { write_baked_ply(f, mesh, 1); });
  EXPECT_NE(read_text(file).find("\ncomment origin 2000002 -999999 101\n"), std::string::npos);
  const Vec3 p = read_scene(file).polygons.vertices[0];
  EXPECT_LT(length(p + Vec3{2000002, -999999, 101} - mesh.position[0]), 1e-6);
}

TEST_F(BakedFiles, ObjHasColoursNormalsAndObjectsAndAllDigits) {
  const WrittenResult r = two_surfaces({2e6, -1e6, 100});
  const BakedMesh mesh = baked_points(r);
  const std::string file = written("a.obj", [&](AtomicFile& f) { write_baked_obj(f, mesh, names_of(r), kExposure); });
  std::istringstream lines(read_text(file));
  std::size_t v = 0, vn = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string key;
    double x[6];
    words >> key;
    if (key == "v") {
      for (double& value : x) words >> value;
      EXPECT_EQ((Vec3{x[0], x[1], x[2]}), mesh.position[v]);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(x[3 + k], srgb_encoded(mesh.shown[v][k] * kExposure), 1e-6);
      ++v;
    }
    if (key == "vn") ++vn;
  }
  EXPECT_EQ(v, 50u);
  EXPECT_EQ(vn, 50u);
  const Scene scene = read_scene(file);
  EXPECT_EQ(scene.surfaces, (std::vector<std::string>{"floor", "wall ä"}));
  expect_same_geometry(scene, mesh, 1e-9);
}

TEST_F(BakedFiles, GlbHasANodeASurfaceWithItsLight) {
  const WrittenResult r = two_surfaces();
  const BakedMesh mesh = baked_points(r);
  const std::string file = written("a.glb", [&](AtomicFile& f) {
    write_baked_glb(f, mesh, names_of(r), {kExposure, {}});
  });
  const GlbFile glb(file);
  ASSERT_EQ(glb.json["nodes"].size(), 2u);
  EXPECT_EQ(glb.json["extensionsUsed"], nlohmann::json({"KHR_materials_unlit"}));
  for (const char* name : {"floor", "wall ä"}) {
    const nlohmann::json& shape = glb.json["meshes"][glb.node(name)["mesh"].get<std::size_t>()];
    EXPECT_EQ(shape["name"], name);
    EXPECT_EQ(shape["extras"]["exposure"], kExposure);
    ASSERT_EQ(shape["primitives"].size(), 1u);
    const nlohmann::json& attributes = shape["primitives"][0]["attributes"];
    const auto position = glb.numbers(attributes["POSITION"]), normal = glb.numbers(attributes["NORMAL"]),
               colour = glb.numbers(attributes["COLOR_0"]), lux = glb.numbers(attributes["_ILLUMINANCE"]),
               E = glb.numbers(attributes["_IRRADIANCE"]);
    ASSERT_EQ(lux.size(), 25u);
    ASSERT_EQ(colour.size(), 75u);
    const std::size_t first = name[0] == 'f' ? 0 : 25;
    for (std::size_t i = 0; i < 25; ++i) {
      // Found by where it is, y up: (x, y, z) is (x, -z, y) there.
      std::size_t at = first;
      const Vec3 p{position[3 * i], -position[3 * i + 2], position[3 * i + 1]};
      while (at < first + 25 && length(mesh.position[at] - p) > 1e-6) ++at;
      ASSERT_LT(at, first + 25);
      const Vec3 n{normal[3 * i], -normal[3 * i + 2], normal[3 * i + 1]};
      EXPECT_LT(length(n - mesh.normal[at]), 1e-6);
      EXPECT_EQ(lux[i], double{r.of_points.at("illuminance").value[at]});
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(E[3 * i + k], double{r.of_points.at("irradiance").value[3 * at + k]});
        EXPECT_NEAR(colour[3 * i + k], std::min(1.0, mesh.shown[at][static_cast<int>(k)] * kExposure), 1e-6);
      }
    }
    const nlohmann::json& accessor = glb.json["accessors"][attributes["POSITION"].get<std::size_t>()];
    for (std::size_t k = 0; k < 3; ++k) {
      double least = 1e9;
      for (std::size_t i = k; i < 75; i += 3) least = std::min(least, position[i]);
      EXPECT_EQ(accessor["min"][k].get<double>(), least);
    }
    const nlohmann::json& material = glb.json["materials"][shape["primitives"][0]["material"].get<std::size_t>()];
    EXPECT_TRUE(material["extensions"].contains("KHR_materials_unlit"));
    EXPECT_FALSE(material.value("doubleSided", false));
    EXPECT_EQ(material["pbrMetallicRoughness"]["baseColorFactor"],
              first == 0 ? nlohmann::json({0.25, 0.5, 0.75, 1}) : nlohmann::json({1, 1, 1, 1}));
  }
  expect_same_geometry(read_scene(file), mesh, 1e-6);
}

TEST_F(BakedFiles, GlbFarFromTheOriginKeepsItsMillimetres) {
  const WrittenResult r = two_surfaces({2e6, -1e6, 100});
  const BakedMesh mesh = baked_points(r);
  const std::string file = written("a.glb", [&](AtomicFile& f) { write_baked_glb(f, mesh, names_of(r), {1, {}}); });
  const GlbFile glb(file);
  EXPECT_EQ(glb.json["scenes"][0]["nodes"].size(), 1u);
  EXPECT_EQ(glb.node("origin")["translation"], nlohmann::json({2000002.0, 101.0, 999999.0}));
  expect_same_geometry(read_scene(file), mesh, 1e-6);
}

TEST_F(BakedFiles, GlbWithAPictureShowsThatInPlaceOfColours) {
  const WrittenResult r = two_surfaces();
  BakedMesh mesh = baked_points(r);
  for (const Vec3& p : mesh.position)
    mesh.atlas_uv.push_back({static_cast<float>(p.x) / 4, static_cast<float>(p.y) / 3});
  const GlbFile glb(written("a.glb", [&](AtomicFile& f) { write_baked_glb(f, mesh, names_of(r), {1, "light.png"}); }));
  const nlohmann::json& primitive = glb.primitive("floor");
  EXPECT_FALSE(primitive["attributes"].contains("COLOR_0"));
  EXPECT_EQ(primitive["attributes"]["TEXCOORD_0"], primitive["attributes"]["TEXCOORD_1"]);
  EXPECT_EQ(glb.json["images"][0]["uri"], "light.png");
  const nlohmann::json& material = glb.json["materials"][primitive["material"].get<std::size_t>()];
  EXPECT_EQ(material["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"], 1);
}

}  // namespace
}  // namespace clerestory
