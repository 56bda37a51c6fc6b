#include "solver/hierarchy/shadow_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/illumination/sharp_light.h"
#include "solver/model/random_stream.h"
#include "solver/sampling/unit_square.h"
#include "tests/meshing/mesh_checks.h"
#include "tests/solver/hierarchy/field_scenes.h"

namespace clerestory {
namespace {

using testing::MeshedRoom;
using testing::SceneMaker;

const Vec3 kToSun = normalized(Vec3{0.3, -0.2, 1});
constexpr double kHeight = 1.5;  ///< of what throws the shadow [m]

/// A floor of 4 x 4 m, and over it a plate of 1.2 x 1 m, turned so that its shadow follows no edge of the mesh.
SceneMaker floor_and_plate() {
  SceneMaker maker;
  maker.polygon({{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  const Vec3 u{0.6 * std::cos(0.3), 0.6 * std::sin(0.3), 0}, v{-0.5 * std::sin(0.3), 0.5 * std::cos(0.3), 0};
  const Vec3 middle{0.1, 0, kHeight};
  maker.polygon({middle - u - v, middle + u - v, middle + u + v, middle - u + v});
  return maker;
}
constexpr double kShadow = 1.2 * 1.0;  ///< of the sun: the plate's own area, as the two are parallel [m2]

/// The floor alone, in the light of one sun or lamp.
struct Floor {
  MeshedRoom room;
  ElementMesh mesh;

  explicit Floor(const SceneMaker& maker) : room(maker, 0.3), mesh(room.patches, room.map) {}

  ShadowEdges cut(double lit = 1000) {
    Field E(mesh.leaf_count(), 1);
    for (double& x : E.value) x = lit;
    return cut_shadow_edges(mesh, room.problem(), E, {.shortest_edge = 0.03});
  }
  bool is_floor(std::uint32_t leaf) const {
    const auto x = mesh.corner_positions(leaf);
    return room.patches.normal[mesh[leaf].patch].z > 0.9 && x[0].z + room.patches.origin.z < 0.1;
  }
};

SceneMaker in_the_sun() {
  SceneMaker maker = floor_and_plate();
  maker.scene().lights.suns.push_back({kToSun, Spectrum(1000)});
  return maker;
}

/// Areas of the floor [m2]: what is in the dark, across an edge, and neither lit nor dark as a whole.
struct FloorParts {
  double dark = 0, penumbra = 0, mixed = 0;
};
FloorParts parts_of(const Floor& floor) {
  const Problem problem = floor.room.problem();
  const SharpLight sun = sharp_lights(problem, 1).at(0);
  FloorParts parts;
  for (const std::uint32_t leaf : floor.mesh.leaves()) {
    if (!floor.is_floor(leaf)) continue;
    const auto x = floor.mesh.corner_positions(leaf);
    int lit = 0;
    for (std::uint32_t k = 0; k < 32; ++k) {
      const auto u = sobol4(k, leaf);
      lit += sun.sees_centre(point_on_triangle(x, u[0], u[1]), {0, 0, 1});
    }
    if (floor.mesh[leaf].penumbra)
      parts.penumbra += floor.mesh[leaf].area;
    else if (lit > 0 && lit < 32)
      parts.mixed += floor.mesh[leaf].area;
    else if (lit == 0)
      parts.dark += floor.mesh[leaf].area;
  }
  return parts;
}

TEST(ShadowEdges, PartTheFloorIntoLightAndDarkWithThePenumbraBetween) {
  Floor floor(in_the_sun());
  const double area = floor.room.patches.total_area();
  ASSERT_GT(floor.cut().cut, 20u);
  const auto [dark, penumbra, mixed] = parts_of(floor);
  // Around the shadow of a plate at height h the penumbra is the sun's diameter h wide, and half of it is dark.
  const double width = kHeight / kToSun.z * 0.533 * std::numbers::pi / 180, rim = 2 * (1.2 + 1.0);
  EXPECT_NEAR(penumbra, width * rim, 0.35 * width * rim);
  EXPECT_NEAR(dark + penumbra / 2, kShadow, 0.02 * kShadow);
  EXPECT_LT(mixed, 0.01 * kShadow);  // at the corners of the shadow
  double sum = 0;
  for (const std::uint32_t leaf : floor.mesh.leaves()) sum += floor.mesh[leaf].area;
  EXPECT_NEAR(sum, area, 1e-9 * area);
}

TEST(ShadowEdges, OfPostsThinnerThanElementsRunOnIntoThoseOfPlates) {
  SceneMaker maker = in_the_sun();
  constexpr double kPost = 0.05;
  // From the floor to the plate's height: two of their shadows end in its own.
  for (const double x : {-0.9, 0.35, 0.8}) {
    const Vec3 low{x, -0.9, 0}, side{kPost, 0, 0}, deep{0, kPost, 0}, up{0, 0, kHeight};
    for (const auto& [from, to] : {std::pair{low, low + side},
                                   {low + side, low + side + deep},
                                   {low + side + deep, low + deep},
                                   {low + deep, low}})
      maker.polygon({from, to, to + up, from + up});
  }
  Floor floor(maker);
  ASSERT_GT(floor.cut().cut, 100u);
  const auto [dark, penumbra, mixed] = parts_of(floor);
  EXPECT_GT(dark, kShadow + 0.02);
  // Where the penumbrae of a post's two edges meet; 0.012 with elements no smaller than others.
  EXPECT_LT(mixed, 0.007);
  EXPECT_TRUE(floor.mesh.is_sound());
}

TEST(ShadowEdges, OfOneOfSeveralTimesAreThoseOfThatTime) {
  constexpr std::size_t kTimes = 10;
  SceneMaker maker = floor_and_plate();
  LightSpec& lights = maker.scene().lights;
  lights.suns.push_back({kToSun, Spectrum(1000.0 / kTimes), 3});
  lights.times = kTimes;
  // Floors that are as bright at all other times: the sun has a tenth of the mean light.
  EXPECT_EQ(Floor(maker).cut(1000).cut, Floor(in_the_sun()).cut(1000).cut);
  lights.suns[0].time = {};
  EXPECT_EQ(Floor(maker).cut(1000).cut, 0u);  // a weak sun that shines always
}

TEST(ShadowEdges, LeaveASoundMeshOfTrianglesThatAreNotTooThin) {
  Floor floor(in_the_sun());
  const std::size_t before = floor.mesh.leaf_count();
  floor.cut();
  EXPECT_TRUE(floor.mesh.is_sound());
  const PatchSet leaves = floor.mesh.leaf_patches();
  EXPECT_EQ(testing::t_vertices(leaves), 0u);
  EXPECT_LT(leaves.patch_count(), 3 * before);
  for (std::size_t p = 0; p < leaves.patch_count(); ++p) {
    const auto x = leaves.corner_positions(PatchId{p});
    const Vec3 n = cross(x[1] - x[0], x[2] - x[0]);
    EXPECT_GT(dot(n, leaves.normal[p]), 0);
    EXPECT_NEAR(length(n) / 2, leaves.area[p], 1e-9);
    EXPECT_GT(testing::smallest_angle(x), 0.5 * std::numbers::pi / 180);
  }
  // Rays know the parts.
  int met = 0;
  for (std::uint32_t k = 0; k < 4000; ++k) {
    const auto u = sobol4(k, 1);
    const Vec3 from = Vec3{4 * u[0] - 2, 4 * u[1] - 2, 0.5} - floor.room.patches.origin;
    const Hit hit = floor.room.rays.first_hit(leaves, {from, {0, 0, -1}});
    ASSERT_TRUE(hit.patch.valid());
    const auto x = leaves.corner_positions(hit.patch);
    const Vec3 at = from - Vec3{0, 0, 1} * hit.distance;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 edge = x[(i + 1) % 3] - x[i], inward = cross(leaves.normal[hit.patch], edge);
      EXPECT_GT(dot(at - x[i], inward) / length(inward), -2e-5);
    }
    met += leaves.level[hit.patch] > 0;
  }
  EXPECT_GT(met, 100);
}

TEST(ShadowEdges, OfALampThatIsAPointAreMillimetresWide) {
  SceneMaker maker = floor_and_plate();
  maker.scene().lights.luminaires.push_back({"lamp", {0, 0, 3}, "", PointLuminaire{Spectrum(1000)}});
  Floor floor(maker);
  ASSERT_GT(floor.cut(1).cut, 20u);
  double penumbra = 0;
  for (const std::uint32_t leaf : floor.mesh.leaves())
    if (floor.is_floor(leaf) && floor.mesh[leaf].penumbra) penumbra += floor.mesh[leaf].area;
  const double rim = 2 * 2 * (1.2 + 1.0);  // the plate hangs half way
  EXPECT_LT(penumbra, rim * 0.006);
  EXPECT_GT(penumbra, rim * 0.001);
}

TEST(ShadowEdges, AreDrawnByLightsThatMatterOnly) {
  Floor floor(in_the_sun());
  const std::size_t before = floor.mesh.leaf_count();
  const ShadowEdges edges = floor.cut(1e5);
  EXPECT_EQ(edges.cut, 0u);
  EXPECT_EQ(edges.halved, 0u);
  EXPECT_EQ(floor.mesh.leaf_count(), before);
}

TEST(ShadowEdges, ThatAreCurvedAreHalvedUntilTheyAreStraight) {
  SceneMaker maker;
  maker.polygon({{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  std::vector<Vec3> disc;
  for (int k = 0; k < 64; ++k) {
    const double phi = 2 * std::numbers::pi * k / 64;
    disc.push_back({0.5 * std::cos(phi), 0.5 * std::sin(phi), 0.2});
  }
  maker.polygon(disc);
  maker.scene().lights.suns.push_back({{0, 0, 1}, Spectrum(1000)});
  Floor floor(maker);
  const ShadowEdges edges = floor.cut();
  EXPECT_GT(edges.halved, 0u);
  EXPECT_GT(edges.cut, 0u);
  EXPECT_TRUE(floor.mesh.is_sound());
  double dark = 0;
  const Problem problem = floor.room.problem();
  const SharpLight sun = sharp_lights(problem, 1).at(0);
  for (const std::uint32_t leaf : floor.mesh.leaves()) {
    if (!floor.is_floor(leaf)) continue;
    const auto x = floor.mesh.corner_positions(leaf);
    const bool lit = sun.sees_centre((x[0] + x[1] + x[2]) / 3, {0, 0, 1});
    dark += floor.mesh[leaf].penumbra ? floor.mesh[leaf].area / 2 : lit ? 0 : floor.mesh[leaf].area;
  }
  EXPECT_NEAR(dark, std::numbers::pi * 0.25, 0.01 * std::numbers::pi * 0.25);
}

TEST(ElementMesh, IsCutWhereverItIsAsked) {
  const MeshedRoom room(testing::room_with_box(), 0.6);
  ElementMesh mesh(room.patches, room.map);
  for (std::uint32_t k = 0; k < 100; ++k) {
    const auto u = sobol4(k, 3);
    const std::vector<std::uint32_t> leaves = mesh.leaves();
    const std::uint32_t leaf = leaves[static_cast<std::size_t>(u[0] * static_cast<double>(leaves.size()))];
    const auto edge = static_cast<std::size_t>(3 * u[1]);
    const auto x = mesh.corner_positions(leaf);
    const double area = mesh[leaf].area, at = 0.3 + 0.4 * u[2];
    mesh.cut(leaf, edge, at);
    const std::uint32_t first = mesh[leaf].first;
    EXPECT_NEAR(mesh[first].area, at * area, 1e-5 * area);
    EXPECT_NEAR(mesh[first].area + mesh[first + 1].area, area, 1e-15 * area);
    EXPECT_LT(length(mesh.corner_positions(first)[1] - (x[edge] * (1 - at) + x[(edge + 1) % 3] * at)), 1e-5);
    EXPECT_EQ(mesh.corner_positions(leaf), x);  // of what was parted
  }
  EXPECT_TRUE(mesh.is_sound());
  EXPECT_NEAR(mesh.leaf_patches().total_area(), room.patches.total_area(), 1e-9);
}

}  // namespace
}  // namespace clerestory
