// Models as people have them; skipped where they are not at hand.

#include <filesystem>

#include <gtest/gtest.h>

#include "io/read_scene.h"
#include "meshing/make_lightmap.h"
#include "tests/meshing/mesh_checks.h"

namespace clerestory {
namespace {

using namespace testing;

struct Model {
  const char* file;
  std::size_t fewest, most;  ///< triangles
};
void PrintTo(const Model& m, std::ostream* out) { *out << m.file; }

class RealModel : public ::testing::TestWithParam<Model> {};

TEST_P(RealModel, GivesASoundMeshOfABoundedSize) {
  const std::filesystem::path file =
      std::filesystem::path(CLERESTORY_SOURCE_DIR) / "../shared/data/models" / GetParam().file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  const Scene scene = read_scene(file);
  const auto [p, report] = build_patches(scene);
  EXPECT_EQ(t_vertices(p), 0u);
  EXPECT_EQ(coincident_triangles(p), 0u);
  EXPECT_LE(report.longest_edge, report.max_element * (1 + 1e-9));
  EXPECT_GE(p.triangle_count(), GetParam().fewest);
  EXPECT_LE(p.triangle_count(), GetParam().most);
  const VertexLightmap map = make_lightmap(p);
  EXPECT_EQ(map.corners.size(), p.patch_count());
}

INSTANTIATE_TEST_SUITE_P(All, RealModel,
                         ::testing::Values(Model{"cornell_box.obj", 4000, 8000}, Model{"gazebo.obj", 4000, 20000},
                                           Model{"living_room.glb", 1000, 20000},
                                           Model{"LargeBuilding.obj", 20000, 100000},
                                           Model{"LargeBuilding.ifc", 20000, 100000}));

}  // namespace
}  // namespace clerestory
