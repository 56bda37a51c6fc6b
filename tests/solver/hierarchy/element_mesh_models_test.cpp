// Elements of models as people have them, skipped where they are not at hand: cut in the sun, and halved.

#include <filesystem>

#include <gtest/gtest.h>

#include "io/read_scene.h"
#include "meshing/build_patches.h"
#include "meshing/make_lightmap.h"
#include "solver/hierarchy/shadow_edges.h"
#include "solver/illumination/place_lights.h"
#include "solver/model/random_stream.h"

namespace clerestory {
namespace {

class ElementsOfModel : public ::testing::TestWithParam<const char*> {};

TEST_P(ElementsOfModel, AreSoundCutAndHalved) {
  const std::filesystem::path file = std::filesystem::path(CLERESTORY_SOURCE_DIR) / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  PatchSet patches = std::move(build_patches(read_scene(file)).patches);
  make_patches(patches, std::vector<bool>(2 * patches.triangle_count(), true));
  const RayScene rays(patches);
  LightSpec spec;
  spec.suns.push_back({normalized(Vec3{0.3, -0.5, 0.8}), Spectrum(1000)});
  const Lights lights = place_lights(spec, patches, rays);
  ElementMesh mesh(patches, make_lightmap(patches));
  EXPECT_TRUE(mesh.is_sound());

  Field dark(patches.patch_count(), patches.channels);
  const ShadowEdges edges = cut_shadow_edges(mesh, {patches, rays, lights}, dark, {.shortest_edge = 0.1});
  EXPECT_GT(edges.cut, 0u);
  EXPECT_TRUE(mesh.is_sound());
  std::vector<std::uint32_t> marked;
  for (const std::uint32_t leaf : mesh.leaves())
    if (mix_bits(leaf) % 5 == 0) marked.push_back(leaf);
  mesh.split(marked);
  EXPECT_TRUE(mesh.is_sound());

  double before = 0, after = 0;
  for (const double a : patches.area) before += a;
  const std::vector<std::uint32_t> leaves = mesh.leaves();
  EXPECT_EQ(leaves.size(), mesh.leaf_count());
  for (const std::uint32_t leaf : leaves) {
    after += mesh[leaf].area;
    for (const std::uint32_t other : mesh.neighbours(leaf)) {
      if (other == VertexLightmap::kNone) continue;
      const auto back = mesh.neighbours(other);
      EXPECT_NE(std::find(back.begin(), back.end(), leaf), back.end());
    }
  }
  EXPECT_NEAR(after, before, 1e-9 * before);
}

INSTANTIATE_TEST_SUITE_P(Shared, ElementsOfModel,
                         ::testing::Values("../shared/data/models/gazebo.obj", "../shared/data/models/living_room.glb",
                                           "../shared/data/models/zdm2.glb", "../shared/data/models/LargeBuilding.obj",
                                           "../shared/data/models/LargeBuilding.ifc",
                                           "../shared/data/models/TallBuilding.ifc",
                                           "../shared/data/models/Duplex_A.ifc"));
INSTANTIATE_TEST_SUITE_P(Own, ElementsOfModel, ::testing::Values("data/scenes/house.obj", "data/scenes/office.obj"));

}  // namespace
}  // namespace clerestory
