#include "meshing/find_outlines.h"

#include <cmath>

#include <gtest/gtest.h>

#include "meshing/make_lightmap.h"
#include "tests/meshing/mesh_checks.h"

namespace clerestory {
namespace {

using namespace testing;

MeshedScene mesh(SceneMaker& maker, double max_element) {
  return build_patches(maker.scene(), {.max_element = max_element});
}

/// Turned by 33 degrees about z, so that nothing lies on a grid.
Vec3 turned(const Vec3& p) {
  const double c = std::cos(0.576), s = std::sin(0.576);
  return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}
Vec3 turned_back(const Vec3& p) {
  const double c = std::cos(0.576), s = std::sin(0.576);
  return {c * p.x + s * p.y, -s * p.x + c * p.y, p.z};
}
void add(SceneMaker& maker, std::vector<Vec3> corners, MaterialId m = MaterialId{std::size_t{0}}) {
  for (Vec3& p : corners) p = turned(p);
  maker.polygon(corners, m);
}

/// Area [m2] of triangles in the plane z = `height` that have corners on both sides of the line x = 0, 0 < y < 3, by
/// more than rounding.
double straddling_area(const PatchSet& p, double height) {
  double area = 0;
  for (std::size_t t = 0; t < p.triangle_count(); ++t) {
    double left = 0, right = 0;
    bool counts = true;
    for (const VertexId v : p.corners[t]) {
      const Vec3 x = turned_back(p.vertices[v] + p.origin);
      counts = counts && std::abs(x.z - height) < 1e-5 && x.y > -1e-5 && x.y < 3 + 1e-5;
      left = std::min(left, x.x), right = std::max(right, x.x);
    }
    if (counts && left < -1e-5 && right > 1e-5) area += triangle_area(p, t);
  }
  return area;
}

/// A slab 4 x 3 at z = 3, and a wall across it that ends `gap` below; thickness 0: one sheet.
void add_wall_under_slab(SceneMaker& maker, double gap, double thickness) {
  add(maker, {{-2, 0, 3}, {2, 0, 3}, {2, 3, 3}, {-2, 3, 3}});
  const double top = 3 - gap, back = -thickness;
  add(maker, {{0, 0, 0}, {0, 3, 0}, {0, 3, top}, {0, 0, top}});
  if (thickness == 0) return;
  add(maker, {{back, 0, 0}, {back, 3, 0}, {back, 3, top}, {back, 0, top}});
  add(maker, {{0, 0, top}, {0, 3, top}, {back, 3, top}, {back, 0, top}});
}

TEST(FindOutlines, NoElementOfASlabLiesOnBothSidesOfAWallThatEndsBelowIt) {
  for (const double gap : {1e-4, 1e-3, 1e-2, 3e-2})
    for (const double thickness : {0.0, 0.2}) {
      SCOPED_TRACE(::testing::Message() << gap << " m, " << thickness << " m thick");
      SceneMaker maker;
      add_wall_under_slab(maker, gap, thickness);
      const auto [p, report] = mesh(maker, 0.3);
      EXPECT_EQ(straddling_area(p, 3), 0);
      EXPECT_EQ(report.imprinted_outlines, thickness > 0 ? 2u : 1u);
      EXPECT_GT(report.worst_angle_deg, 20);  // no slivers
      EXPECT_EQ(t_vertices(p), 0u);
      EXPECT_EQ(coincident_triangles(p), 0u);
    }
}

TEST(FindOutlines, AWallThatTouchesHasNone) {
  SceneMaker maker;
  add_wall_under_slab(maker, 0, 0.2);
  EXPECT_EQ(mesh(maker, 0.3).report.imprinted_outlines, 0u);
}

TEST(FindOutlines, AWallFarBelowHasNone) {
  SceneMaker maker;
  add_wall_under_slab(maker, 0.2, 0);
  EXPECT_EQ(mesh(maker, 0.3).report.imprinted_outlines, 0u);
}

TEST(FindOutlines, AWallThatEndsBeforeAFacadePartsTheFacadeAndTheFloorBetween) {
  SceneMaker maker;
  add(maker, {{-2, 0, 0}, {2, 0, 0}, {2, 3, 0}, {-2, 3, 0}});        // floor
  add(maker, {{-2, 3, 0}, {2, 3, 0}, {2, 3, 3}, {-2, 3, 3}});        // facade
  add(maker, {{0, 0, 0}, {0, 2.999, 0}, {0, 2.999, 3}, {0, 0, 3}});  // wall on the floor
  const auto [p, report] = mesh(maker, 0.3);
  EXPECT_EQ(straddling_area(p, 0), 0);
  double facade = 0;
  for (std::size_t t = 0; t < p.triangle_count(); ++t) {
    double left = 0, right = 0;
    bool counts = true;
    for (const VertexId v : p.corners[t]) {
      const Vec3 x = turned_back(p.vertices[v] + p.origin);
      counts = counts && std::abs(x.y - 3) < 1e-5;
      left = std::min(left, x.x), right = std::max(right, x.x);
    }
    if (counts && left < -1e-5 && right > 1e-5) facade += triangle_area(p, t);
  }
  EXPECT_EQ(facade, 0);
  EXPECT_EQ(t_vertices(p), 0u);
}

TEST(FindOutlines, ACabinetJustAboveTheFloorIsOneAndItsFeetAreNot) {
  const auto outlines = [](double size) {
    SceneMaker maker;
    maker.polygon({{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
    maker.box({0.3, 0.2, 0.003}, {0.3 + size, 0.2 + size, 0.8});
    return mesh(maker, 0.3).report.imprinted_outlines;
  };
  EXPECT_EQ(outlines(0.6), 4u);
  EXPECT_EQ(outlines(0.04), 0u);
}

TEST(FindOutlines, WhatStandsOnAFloorIsNoneOfTheSlabBelowIt) {
  SceneMaker maker;
  add(maker, {{-2, 0, -0.05}, {2, 0, -0.05}, {2, 3, -0.05}, {-2, 3, -0.05}});
  add(maker, {{-2, 0, 0}, {2, 0, 0}, {2, 3, 0}, {-2, 3, 0}});
  add(maker, {{0, 0.5, 0}, {0, 2.5, 0}, {0, 2.5, 3}, {0, 0.5, 3}});
  EXPECT_EQ(mesh(maker, 0.3).report.imprinted_outlines, 0u);
}

TEST(FindOutlines, ARailOfSmallDepthIsNone) {
  // A strip 3 cm high, 3 cm off: light goes around it.
  SceneMaker maker;
  add(maker, {{-2, 0, 3}, {2, 0, 3}, {2, 3, 3}, {-2, 3, 3}});
  add(maker, {{0, 0, 2.94}, {0, 3, 2.94}, {0, 3, 2.97}, {0, 0, 2.97}});
  EXPECT_EQ(mesh(maker, 0.3).report.imprinted_outlines, 0u);
}

TEST(FindOutlines, LightMayJumpThereOnTheSideOfTheWallOnly) {
  SceneMaker maker;
  add_wall_under_slab(maker, 1e-3, 0);
  const PatchSet p = mesh(maker, 0.3).patches;
  const VertexLightmap map = make_lightmap(p);
  std::size_t on_the_line = 0;
  for (const Vec3& v : p.vertices) {
    const Vec3 x = turned_back(v + p.origin);
    if (std::abs(x.x) > 1e-6 || std::abs(x.z - 3) > 1e-6 || x.y < 0.1 || x.y > 2.9) continue;
    ++on_the_line;
    std::size_t points = 0, from_above = 0;
    for (std::size_t i = 0; i < map.position.size(); ++i) {
      if (length(map.position[i] - v) > 1e-9) continue;
      ++points;
      from_above += p.normal[map.patch_of_point[i]].z > 0;
    }
    EXPECT_EQ(points, 3u);
    EXPECT_EQ(from_above, 1u);
  }
  EXPECT_GT(on_the_line, 5u);
}

}  // namespace
}  // namespace clerestory
