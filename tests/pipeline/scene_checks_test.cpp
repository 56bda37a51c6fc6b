#include "pipeline/scene_checks.h"

#include <gtest/gtest.h>

#include "pipeline/prepare.h"

namespace clerestory {
namespace {

struct Listener : Observer {
  void warn(const std::string& line) override { warnings.push_back(line); }
  std::vector<std::string> warnings;
};

/// A floor of 10 x 10 m at z = 0 under nothing.
Scene floor() {
  Scene scene;
  scene.file = "floor";
  scene.surfaces = {"floor"};
  scene.materials.emplace_back().name = "floor";
  scene.materials[0].reflectance = Spectrum(0.5);
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}, {0.0, 10.0}}) {
    scene.polygons.add_corner(static_cast<std::uint32_t>(scene.polygons.vertices.size()));
    scene.polygons.add_vertex({x, y, 0});
  }
  scene.polygons.end_face(MaterialId{std::size_t{0}}, SurfaceId{std::size_t{0}});
  return scene;
}

/// A box of 1 m upon it, its faces outward, around (5, 5, 0.6).
void add_box(Scene& scene) {
  const std::size_t first = scene.polygons.vertices.size();
  for (const double z : {0.1, 1.1})
    for (const auto& [x, y] : {std::pair{4.5, 4.5}, {5.5, 4.5}, {5.5, 5.5}, {4.5, 5.5}})
      scene.polygons.add_vertex({x, y, z});
  constexpr std::size_t kFaces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                        {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  for (const auto& face : kFaces) {
    for (const std::size_t v : face) scene.polygons.add_corner(static_cast<std::uint32_t>(first + v));
    scene.polygons.end_face(MaterialId{std::size_t{0}}, SurfaceId{std::size_t{0}});
  }
}

/// What `check` says of the places of lights and sensors.
std::vector<std::string> warnings_about(const Scene& scene) {
  StageSeconds seconds;
  const auto prepared = prepare(scene, {.solve = {.accuracy = Accuracy::draft}}, {}, seconds);
  Listener listener;
  warn_about_places(prepared->problem(), scene, planes_of(scene.sensors), Method::hierarchical, listener);
  return listener.warnings;
}

Luminaire point(double x, double z) { return {"lamp", {x, 5, z}, {}, PointLuminaire{Spectrum(1.0)}}; }

TEST(SceneChecks, AFewLuminairesInTheOpenAreNamedOneByOne) {
  Scene scene = floor();
  for (int k = 0; k < 3; ++k) scene.lights.luminaires.push_back(point(k, 20));
  const std::vector<std::string> warnings = warnings_about(scene);
  ASSERT_EQ(warnings.size(), 3u);
  EXPECT_NE(warnings[2].find("luminaire 'lamp' at (2.000, 5.000, 20.00) stands outside every room"), std::string::npos)
      << warnings[2];
}

TEST(SceneChecks, OfVeryManyLuminairesTheFirstAreNamedAndTheOthersCounted) {
  // At 256 rays each, and as many for the sides that they light, this takes minutes.
  constexpr std::size_t kCount = 200'000;
  Scene scene = floor();
  for (std::size_t k = 0; k < kCount; ++k) scene.lights.luminaires.push_back(point(static_cast<double>(k) * 5e-5, 20));
  const std::vector<std::string> warnings = warnings_about(scene);
  ASSERT_EQ(warnings.size(), 21u);
  EXPECT_EQ(warnings.back(), "about 199,980 more luminaires stand outside every room.");
}

TEST(SceneChecks, OfVeryManySensorsSomeAreLookedAt) {
  Scene scene = floor();
  add_box(scene);
  scene.lights.luminaires.push_back(point(5, 2));
  constexpr std::size_t kCount = 5'000'000;  // 32 rays each take minutes
  SensorSet& set = scene.sensors.emplace_back();
  set.points.assign(kCount, {{5, 5, 1.5}, {0, 0, 1}});
  const std::size_t of_the_luminaire = warnings_about(scene).size();
  set.points.assign(kCount, {{5, 5, 0.6}, {0, 0, 1}});  // in the box
  const std::vector<std::string> warnings = warnings_about(scene);
  ASSERT_EQ(warnings.size(), of_the_luminaire + 1);
  EXPECT_NE(warnings.back().find("of 98,040 sensors looked at, one in 51, 98,040 (rows 1, 52, 103,"), std::string::npos)
      << warnings.back();
}

TEST(SceneChecks, UnusedRulesAreNotComparedWithEveryNameOfAHugeModel) {
  Scene scene;
  scene.file = "s.json";
  for (int k = 0; k < 2000; ++k) scene.unused_materials.push_back(std::string(60, 'x') + std::to_string(k));
  for (int k = 0; k < 100'000; ++k) scene.materials.emplace_back().name = std::string(900, 'y') + std::to_string(k);
  Listener listener;
  warn_about_scene(scene, listener);
  EXPECT_EQ(listener.warnings.size(), 2000u);
}

}  // namespace
}  // namespace clerestory
