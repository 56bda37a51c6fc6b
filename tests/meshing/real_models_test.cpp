// Models as people have them, skipped where they are not at hand, and the scenes of data/.

#include <filesystem>

#include <gtest/gtest.h>

#include "io/read_scene.h"
#include "meshing/make_lightmap.h"
#include "tests/meshing/mesh_checks.h"
#include "tests/meshing/patch_mesh_checks.h"

namespace clerestory {
namespace {

using namespace testing;

struct Model {
  const char* file;
  std::size_t fewest, most;  ///< triangles
  std::size_t covered = 0;   ///< slivers that cover each other at most: meshing/README.md, Limits
};
void PrintTo(const Model& m, std::ostream* out) { *out << m.file; }

class RealModel : public ::testing::TestWithParam<Model> {};

TEST_P(RealModel, GivesASoundMeshOfABoundedSize) {
  const std::filesystem::path file = std::filesystem::path(CLERESTORY_SOURCE_DIR) / GetParam().file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  const Scene scene = read_scene(file);
  const auto [p, report] = build_patches(scene);
  EXPECT_EQ(t_vertices(p), 0u);
  EXPECT_LE(coincident_triangles(p), GetParam().covered);
  EXPECT_LE(report.longest_edge, report.max_element * (1 + 1e-9));
  EXPECT_GE(p.triangle_count(), GetParam().fewest);
  EXPECT_LE(p.triangle_count(), GetParam().most);
  const VertexLightmap map = make_lightmap(p);
  EXPECT_EQ(map.corners.size(), p.patch_count());
  const PatchMesh mesh = join_patches(p, map.neighbour);
  EXPECT_EQ(wrong_links(mesh), "");
  EXPECT_EQ(lost_neighbours(mesh, map), 0u);
  EXPECT_EQ(torn_corners(p, mesh), 0u);
}

INSTANTIATE_TEST_SUITE_P(Shared, RealModel,
                         ::testing::Values(Model{"../shared/data/models/cornell_box.obj", 4000, 8000},
                                           Model{"../shared/data/models/gazebo.obj", 4000, 20000},
                                           Model{"../shared/data/models/living_room.glb", 1000, 20000},
                                           Model{"../shared/data/models/zdm2.glb", 20000, 200000},
                                           Model{"../shared/data/models/LargeBuilding.obj", 20000, 100000},
                                           Model{"../shared/data/models/LargeBuilding.ifc", 20000, 100000},
                                           Model{"../shared/data/models/TallBuilding.ifc", 10000, 40000},
                                           Model{"../shared/data/models/Duplex_A.ifc", 50000, 200000, 2}));
INSTANTIATE_TEST_SUITE_P(Own, RealModel,
                         ::testing::Values(Model{"data/scenes/classroom.json", 4000, 20000},
                                           Model{"data/scenes/cornell_box.json", 4000, 20000},
                                           Model{"data/scenes/furnace.json", 4000, 20000},
                                           Model{"data/scenes/house.json", 4000, 20000},
                                           Model{"data/scenes/light_shelf.json", 4000, 20000},
                                           Model{"data/scenes/office.json", 4000, 20000},
                                           Model{"data/scenes/parallel_plates.json", 4000, 20000}));

}  // namespace
}  // namespace clerestory
