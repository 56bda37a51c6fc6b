#include "meshing/patch_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "meshing/make_lightmap.h"
#include "solver/model/random_stream.h"
#include "tests/meshing/mesh_checks.h"
#include "tests/meshing/patch_mesh_checks.h"

namespace clerestory {
namespace {

using namespace testing;
using Sizes = std::vector<std::size_t>;

PatchSet mesh(SceneMaker& maker, double max_element) {
  MeshOptions options;
  options.max_element = max_element;
  return build_patches(maker.scene(), options).patches;
}
void keep_fronts(PatchSet& p) {
  std::vector<bool> fronts(2 * p.triangle_count(), false);
  for (std::size_t t = 0; t < p.triangle_count(); ++t) fronts[2 * t + kFront] = true;
  make_patches(p, fronts);
}
/// Joined as the lightmap says, and sound.
PatchMesh joined(const PatchSet& p) {
  const VertexLightmap map = make_lightmap(p);
  PatchMesh m = join_patches(p, map.neighbour);
  EXPECT_EQ(m.n_faces(), p.patch_count());
  EXPECT_EQ(wrong_links(m), "");
  EXPECT_EQ(lost_neighbours(m, map), 0u);
  EXPECT_EQ(torn_corners(p, m), 0u);
  return m;
}
/// Patches in each fan around a place of the scene, the fewest first.
Sizes fans_at(const PatchSet& p, const PatchMesh& m, const Vec3& place) {
  std::map<int, std::size_t> patches;
  for (std::size_t i = 0; i < p.patch_count(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (length(p.corner_positions(PatchId{i})[k] + p.origin - place) < 1e-9)
        ++patches[half_edges(m, i)[k].from().idx()];
  Sizes sizes;
  for (const auto& [fan, count] : patches) sizes.push_back(count);
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}
/// Lengths of the boundary loops in edges, the shortest first.
Sizes boundary_loops(const PatchMesh& m) {
  Sizes lengths;
  std::set<int> seen;
  for (const auto start : m.halfedges()) {
    if (!start.is_boundary() || seen.contains(start.idx())) continue;
    std::size_t edges = 0;
    for (auto at = start; seen.insert(at.idx()).second; at = at.next()) ++edges;
    lengths.push_back(edges);
  }
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}
/// V - E + F: 2 for each closed surface without handles.
long euler(const PatchMesh& m) {
  return static_cast<long>(m.n_vertices()) - static_cast<long>(m.n_edges()) + static_cast<long>(m.n_faces());
}

TEST(PatchMesh, BothSidesOfATriangleCloseOverItsRim) {
  SceneMaker maker;
  maker.polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const PatchSet p = mesh(maker, 2);
  ASSERT_EQ(p.patch_count(), 2u);
  const PatchMesh m = joined(p);
  EXPECT_EQ(m.n_vertices(), 3u);
  EXPECT_EQ(m.n_edges(), 3u);
  EXPECT_TRUE(boundary_loops(m).empty());
  EXPECT_EQ(make_lightmap(p).position.size(), 6u) << "the rim is a crease";
}

TEST(PatchMesh, OneSideOfATriangleIsOpenAllAround) {
  SceneMaker maker;
  maker.polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  PatchSet p = mesh(maker, 2);
  keep_fronts(p);
  EXPECT_EQ(boundary_loops(joined(p)), (Sizes{3}));
}

TEST(PatchMesh, FacesStartAtTheirPatchsFirstCorner) {
  SceneMaker maker;
  maker.box({0, 0, 0}, {2, 1, 1});
  const PatchSet p = mesh(maker, 0.6);
  const PatchMesh m = joined(p);
  for (std::size_t i = 0; i < p.patch_count(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto fan = static_cast<std::size_t>(half_edges(m, i)[k].from().idx());
      const bool first_around = fan < p.vertices.size();
      EXPECT_TRUE(!first_around || p.vertices[fan] == p.corner_positions(PatchId{i})[k]);
    }
}

TEST(PatchMesh, ABoxIsTwoClosedSurfaces) {
  SceneMaker maker;
  maker.box({0, 0, 0}, {2, 1, 1});
  const PatchSet p = mesh(maker, 0.4);
  const PatchMesh m = joined(p);
  EXPECT_EQ(m.n_vertices(), 2 * p.vertices.size());
  EXPECT_EQ(euler(m), 4);
}

TEST(PatchMesh, ASheetIsOneClosedSurfaceOverItsRim) {
  SceneMaker maker;
  maker.polygon({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}});
  PatchSet p = mesh(maker, 0.4);
  const PatchMesh m = joined(p);
  EXPECT_EQ(euler(m), 2);
  EXPECT_EQ(fans_at(p, m, {0, 0, 0}).size(), 1u) << "around the rim to the back and on";
  keep_fronts(p);
  const PatchMesh front = joined(p);
  const auto edges = edges_by_valence(p);
  EXPECT_EQ(boundary_loops(front), (Sizes{edges.at(1)}));
}

TEST(PatchMesh, ADiffusersSidesAreJoinedToTheWallAroundIt) {
  SceneMaker maker;
  const MaterialId pane = maker.material("pane");
  maker.edit(pane).kind = MaterialKind::diffuser;
  maker.edit(pane).transmittance = Spectrum(0.4);
  maker.polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  maker.polygon({{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}, pane);
  const PatchSet p = mesh(maker, 0.3);
  ASSERT_EQ(p.patch_count(), 2 * p.triangle_count());
  const PatchMesh m = joined(p);
  EXPECT_TRUE(boundary_loops(m).empty());
  EXPECT_EQ(euler(m), 2);
}

TEST(PatchMesh, GlassLeavesVerticesWithoutAFanAndAnOpenEndAroundIt) {
  SceneMaker maker;
  const MaterialId glass = maker.material("glass");
  maker.edit(glass).kind = MaterialKind::glass;
  maker.polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  maker.polygon({{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}, glass);
  const PatchSet p = mesh(maker, 5);
  const PatchMesh m = joined(p);
  const auto isolated = std::count_if(m.vertices_begin(), m.vertices_end(), [&](auto v) { return m.is_isolated(v); });
  EXPECT_EQ(isolated, 2);
  EXPECT_EQ(boundary_loops(m), (Sizes{2})) << "front and back hang together over the other three rims";
}

TEST(PatchMesh, AWallOneElementLongHasTwoEdgesBetweenTheSameFans) {
  SceneMaker maker;
  maker.polygon({{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  maker.polygon({{0, -0.5, 0}, {0, 0.5, 0}, {0, 0.5, 1}, {0, -0.5, 1}});
  const PatchSet p = mesh(maker, 6);
  const PatchMesh m = joined(p);
  EXPECT_TRUE(boundary_loops(m).empty());
  for (const double y : {-0.5, 0.5}) EXPECT_EQ(fans_at(p, m, {0, y, 0}).size(), 2u) << "above and below the floor";
  std::map<std::set<int>, int> edges;
  for (const auto e : m.edges()) ++edges[{e.v0().idx(), e.v1().idx()}];
  EXPECT_EQ(std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.second == 2; }), 2)
      << "its foot and its diagonal, seen from the left and from the right";
  EXPECT_EQ(euler(m), 2) << "around the floor's rim, and up and down the wall";
}

TEST(PatchMesh, BoxesThatTouchInAnEdgeShareItsPlacesAndNotItsFans) {
  SceneMaker maker;
  maker.box({0, 0, 0}, {1, 1, 1});
  maker.box({1, 1, 0}, {2, 2, 1});
  const PatchSet p = mesh(maker, 0.4);
  const PatchMesh m = joined(p);
  EXPECT_TRUE(boundary_loops(m).empty());
  for (const double z : {0.0, 1.0})
    EXPECT_EQ(fans_at(p, m, {1, 1, z}).size(), 3u) << "in one box, in the other, around both";
  EXPECT_EQ(fans_at(p, m, {1, 1, 0.5}).size(), 4u) << "in one box, in the other, on either side";
}

TEST(PatchMesh, WallsThatMeetInAnEdgePartTheRoomAroundIt) {
  SceneMaker maker;
  for (const Vec3 end : {Vec3{1, 0, 0}, Vec3{-0.5, 0.9, 0}, Vec3{-0.5, -0.9, 0}})
    maker.polygon({{0, 0, 0}, end, end + Vec3{0, 0, 1}, {0, 0, 1}});
  const PatchSet p = mesh(maker, 0.4);
  const PatchMesh m = joined(p);
  EXPECT_TRUE(boundary_loops(m).empty());
  EXPECT_EQ(fans_at(p, m, {0, 0, 0.5}).size(), 3u);
  for (const double z : {0.0, 1.0}) EXPECT_EQ(fans_at(p, m, {0, 0, z}).size(), 1u) << "over all three rims";
}

TEST(PatchMesh, NeighboursThatDoNotBothSaySoAreOpenEnds) {
  SceneMaker maker;
  maker.polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  PatchSet p = mesh(maker, 5);
  keep_fronts(p);
  ASSERT_EQ(p.patch_count(), 2u);
  auto neighbour = make_lightmap(p).neighbour;
  const PatchMesh square = join_patches(p, neighbour);
  EXPECT_EQ(boundary_loops(square), (Sizes{4}));
  for (std::uint32_t& q : neighbour[0])  // the other patch over all edges, of which it has one
    q = 1;
  EXPECT_EQ(boundary_loops(join_patches(p, neighbour)), (Sizes{4}));
  neighbour[0] = {VertexLightmap::kNone, VertexLightmap::kNone, VertexLightmap::kNone};
  const PatchMesh apart = join_patches(p, neighbour);
  EXPECT_EQ(wrong_links(apart), "");
  EXPECT_EQ(torn_corners(p, apart), 0u);
  EXPECT_EQ(boundary_loops(apart), (Sizes{3, 3}));
  EXPECT_EQ(apart.n_vertices(), 6u) << "two fans at either end of the diagonal";
}

TEST(PatchMesh, HoldsWhateverTouchesAndWhateverSidesTakePart) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    RandomStream random(seed, 1);
    const auto on_grid = [&] { return std::floor(random.uniform() * 4); };
    SceneMaker maker;
    for (int i = 0; i < 20; ++i) {
      const Vec3 a{on_grid(), on_grid(), on_grid()};
      if (i % 2 == 0)
        maker.box(a, a + Vec3{1 + on_grid(), 1 + on_grid(), 1 + on_grid()});
      else
        maker.polygon({a, {on_grid(), on_grid(), on_grid()}, {on_grid(), on_grid(), on_grid()}});
    }
    PatchSet p = mesh(maker, 10);
    EXPECT_TRUE(boundary_loops(joined(p)).empty()) << "seed " << seed;
    std::vector<bool> sides(2 * p.triangle_count());
    for (std::size_t s = 0; s < sides.size(); ++s) sides[s] = random.uniform() < 0.7;
    make_patches(p, sides);
    EXPECT_FALSE(boundary_loops(joined(p)).empty()) << "seed " << seed;
  }
}

}  // namespace
}  // namespace clerestory
