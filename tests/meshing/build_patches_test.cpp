#include "meshing/build_patches.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "meshing/clean.h"
#include "meshing/make_lightmap.h"
#include "meshing/overlaps.h"
#include "meshing/plane_groups.h"
#include "meshing/stacked_faces.h"
#include "solver/model/error.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "tests/meshing/mesh_checks.h"

namespace clerestory {
namespace {

using namespace testing;
using Counts = std::map<std::size_t, std::size_t>;

MeshedScene mesh(SceneMaker& maker, double max_element) {
  MeshOptions options;
  options.max_element = max_element;
  return build_patches(maker.scene(), options);
}
void expect_sound(const PatchSet& p) {
  EXPECT_EQ(t_vertices(p), 0u);
  EXPECT_EQ(coincident_triangles(p), 0u);
}
/// Length of the edges that `valence` triangles share.
double length_of_edges(const PatchSet& p, std::size_t valence) {
  std::map<std::array<std::uint32_t, 2>, std::size_t> edges;
  for (const auto& c : p.corners)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(c[k].value, c[(k + 1) % 3].value);
      ++edges[{a, b}];
    }
  double sum = 0;
  for (const auto& [e, times] : edges)
    if (times == valence) sum += length(p.vertices[e[0]] - p.vertices[e[1]]);
  return sum;
}
double area_of(const PatchSet& p, MaterialId m, Side side) {
  double area = 0;
  for (std::size_t t = 0; t < p.triangle_count(); ++t)
    if (p.side_material[t][side] == m) area += triangle_area(p, t);
  return area;
}
/// Coordinates lie on a grid of 2^-32 of the model, about 2e-10; areas of a few faces stay within 1e-8 of exact.
constexpr double kRounding = 1e-8;

TEST(BuildPatches, KeepsTheAreaAndClosesABox) {
  SceneMaker maker;
  maker.box({0, 0, 0}, {4, 3, 2.5});
  const auto [p, report] = mesh(maker, 0.5);
  EXPECT_NEAR(surface_area(p), 59, 59 * kRounding);
  EXPECT_NEAR(p.total_area(), 2 * 59, 2 * 59 * kRounding);
  EXPECT_EQ(edges_by_valence(p).size(), 1u);
  EXPECT_TRUE(edges_by_valence(p).contains(2));
  EXPECT_EQ(report.planar_regions, 6u);
  EXPECT_EQ(report.input_faces, 6u);
  expect_sound(p);
  // Euler: V - E + F = 2 for a closed surface without holes.
  const auto V = static_cast<long>(p.vertices.size()), F = static_cast<long>(p.triangle_count());
  EXPECT_EQ(V - 3 * F / 2 + F, 2);
}

TEST(BuildPatches, RespectsTheLongestEdgeWithGoodAngles) {
  SceneMaker maker;
  maker.box({0, 0, 0}, {4, 3, 2.5});
  for (const double longest : {2.0, 0.5, 0.13}) {
    const auto [p, report] = mesh(maker, longest);
    EXPECT_LE(report.longest_edge, longest * (1 + 1e-9));
    EXPECT_GT(report.longest_edge, 0.5 * longest);
    EXPECT_GT(report.worst_angle_deg, 20);  // the bound of Delaunay refinement with right angles in the input
    EXPECT_DOUBLE_EQ(report.max_element, longest);
  }
}

TEST(BuildPatches, WithoutAnElementSizeGivesAboutTheTrianglesAskedFor) {
  for (const double scale : {1e-3, 1.0, 1e4}) {
    SceneMaker maker;
    maker.box({0, 0, 0}, {4 * scale, 3 * scale, 2.5 * scale});
    for (const double target : {600.0, 6000.0, 60000.0}) {
      MeshOptions options;
      options.target_triangles = target;
      // "About": within a third.
      EXPECT_NEAR(static_cast<double>(build_patches(maker.scene(), options).report.triangles), target, target / 3);
    }
  }
}

TEST(BuildPatches, GivesTheSameMeshAtAnyScaleAndPlace) {
  const auto at = [](double scale, Vec3 offset) {
    SceneMaker maker;
    maker.box(offset, offset + Vec3{4, 3, 2.5} * scale);
    maker.box(offset + Vec3{1, 1, 0} * scale, offset + Vec3{2, 1.5, 0.75} * scale);
    maker.polygon({offset + Vec3{3, 0, 0} * scale, offset + Vec3{3, 3, 0} * scale, offset + Vec3{3, 3, 2.5} * scale,
                   offset + Vec3{3, 0, 2.5} * scale});
    return build_patches(maker.scene(), {}).patches;
  };
  const PatchSet one = at(1, {});
  EXPECT_TRUE(one.corners == at(1e-3, {}).corners);
  EXPECT_TRUE(one.corners == at(1e4, {}).corners);
  const PatchSet far = at(1, {1e6, -2e6, 1e6});
  EXPECT_TRUE(one.corners == far.corners);
  EXPECT_NEAR(far.origin.x, 1e6 + 2, 1e-9);
  for (std::size_t v = 0; v < one.vertices.size(); ++v) EXPECT_LT(length(one.vertices[v] - far.vertices[v]), 1e-8);
}

TEST(BuildPatches, GivesTheSameMeshForAnyNumberOfThreads) {
  SceneMaker maker;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) maker.box({i * 0.9, j * 1.1, 0.1 * i}, {i * 0.9 + 1, j * 1.1 + 1, 1});
  set_thread_count(1);
  const PatchSet one = mesh(maker, 0.3).patches;
  set_thread_count(2);
  const PatchSet two = mesh(maker, 0.3).patches;
  set_thread_count(0);
  EXPECT_TRUE(one.corners == two.corners);
  EXPECT_TRUE(one.vertices == two.vertices);
  expect_sound(one);
}

TEST(BuildPatches, ImprintsABoxThatStandsOnAFloor) {
  SceneMaker maker;
  maker.polygon({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  const MaterialId wood = maker.material("wood");
  // No bottom, as in many models; turned, so that nothing is on a grid.
  const Vec3 c{2, 2, 0}, u{0.6, 0.25, 0}, v{-0.25, 0.6, 0}, up{0, 0, 1};
  const std::array<Vec3, 4> foot{c + u + v, c - u + v, c - u - v, c + u - v};
  for (std::size_t k = 0; k < 4; ++k)
    maker.polygon({foot[k], foot[(k + 1) % 4], foot[(k + 1) % 4] + up, foot[k] + up}, wood);
  const auto [p, report] = mesh(maker, 0.5);
  expect_sound(p);
  EXPECT_NEAR(surface_area(p), 16 + 4 * 1.3, 30 * kRounding);
  EXPECT_GT(report.imprinted_contacts, 0u);
  // The foot of the box is in the floor: floor, floor and wall share it.
  EXPECT_NEAR(length_of_edges(p, 3), 4 * 1.3, 1e-7);
  const auto inside = [&](const Vec3& x) {
    const Vec3 d = x + p.origin - c;
    return std::max(std::abs(dot(d, u)), std::abs(dot(d, v))) / dot(u, u) - 1;  // below 0 inside, above 0 outside
  };
  for (std::size_t t = 0; t < p.triangle_count(); ++t) {
    if (p.side_material[t][kFront] == wood) continue;
    double least = 0, most = 0;
    for (const VertexId i : p.corners[t]) {
      least = std::min(least, inside(p.vertices[i]));
      most = std::max(most, inside(p.vertices[i]));
    }
    EXPECT_FALSE(least < -1e-6 && most > 1e-6) << "floor triangle " << t << " lies half under the box";
  }
}

TEST(BuildPatches, CrossingSheetsShareTheirLine) {
  SceneMaker maker;
  maker.polygon({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  maker.polygon({{-0.5, 0.1, -1}, {0.5, 0.2, -1}, {0.5, 0.2, 1}, {-0.5, 0.1, 1}});
  const PatchSet p = mesh(maker, 0.3).patches;
  expect_sound(p);
  EXPECT_NEAR(length_of_edges(p, 4), std::hypot(1, 0.1), 1e-8);
}

TEST(BuildPatches, InterpenetratingBlocksShareTheirLines) {
  SceneMaker maker;
  maker.box({0, 0, 0}, {2, 2, 2});
  maker.box({1, 0.5, 0.5}, {3, 1.5, 1.5});
  const PatchSet p = mesh(maker, 0.5).patches;
  expect_sound(p);
  EXPECT_NEAR(surface_area(p), 24 + 10, 34 * kRounding);
  EXPECT_NEAR(length_of_edges(p, 4), 4, 1e-8);  // around the 1 x 1 m bar where it enters
}

TEST(BuildPatches, ATableLegThatTouchesWithItsTipBecomesAVertexOfTheFloor) {
  SceneMaker maker;
  maker.polygon({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  const Vec3 tip{1.3, 1.7, 0};
  maker.polygon({tip, {1.4, 1.7, 1}, {1.3, 1.8, 1}});
  const PatchSet p = mesh(maker, 1).patches;
  expect_sound(p);
  std::set<std::size_t> around;
  for (std::size_t t = 0; t < p.triangle_count(); ++t)
    for (const VertexId v : p.corners[t])
      if (length(p.vertices[v] + p.origin - tip) < 1e-8) around.insert(t);
  EXPECT_GT(around.size(), 3u);
}

TEST(BuildPatches, RepairsTJunctions) {
  SceneMaker maker;
  // One long wall against two short floors.
  maker.polygon({{0, 0, 0}, {2, 0, 0}, {2, 0, 1}, {0, 0, 1}});
  maker.polygon({{0, 0, 0}, {0, 1, 0}, {0.7, 1, 0}, {0.7, 0, 0}});
  maker.polygon({{0.7, 0, 0}, {0.7, 1, 0}, {2, 1, 0}, {2, 0, 0}}, maker.material("carpet"));
  const auto [p, report] = mesh(maker, 0.4);
  EXPECT_EQ(report.t_junctions, 1u);
  expect_sound(p);
  EXPECT_NEAR(length_of_edges(p, 1), 4 + 4, 1e-8);  // rims of the wall and of the floor, without the line they share
}

TEST(BuildPatches, FacesStoredTwiceWithOppositeWindingBecomeOneWithTwoFronts) {
  SceneMaker maker;
  const MaterialId red = maker.material("red"), blue = maker.material("blue");
  maker.polygon({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, red);   // front up
  maker.polygon({{0, 0, 0}, {0, 1, 0}, {2, 1, 0}, {2, 0, 0}}, blue);  // front down
  const auto [p, report] = mesh(maker, 0.5);
  expect_sound(p);
  EXPECT_EQ(report.opposite_faces, 2u);  // triangles
  EXPECT_NEAR(surface_area(p), 2, 2 * kRounding);
  for (PatchId i{std::size_t{0}}; i.value < p.patch_count(); ++i.value)
    EXPECT_EQ(p.material(i), p.normal[i].z > 0 ? red : blue);
}

TEST(BuildPatches, OneSidedFacesBackToBackBothAct) {
  SceneMaker maker;
  const MaterialId red = maker.material("red"), blue = maker.material("blue");
  for (const MaterialId m : {red, blue}) {
    maker.edit(m).sides = 1;
    maker.edit(m).exitance = Spectrum(m == red ? 10.0 : 20.0);
  }
  maker.polygon({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, red);
  maker.polygon({{0, 0, 0}, {0, 1, 0}, {2, 1, 0}, {2, 0, 0}}, blue);
  maker.polygon({{0, 0, 5}, {2, 0, 5}, {2, 1, 5}, {0, 1, 5}}, red);  // alone: its back is black
  const PatchSet p = mesh(maker, 0.5).patches;
  for (std::size_t i = 0; i < p.patch_count(); ++i) {
    const bool single = p.vertices[p.corners[p.triangle[i]][0]].z + p.origin.z > 1;
    const bool up = p.normal[i].z > 0;
    EXPECT_EQ(p.M[i][0], up ? 10.0 : single ? 0.0 : 20.0);
  }
}

TEST(BuildPatches, DropsExactDuplicatesAndFacesWithoutArea) {
  SceneMaker maker;
  for (int i = 0; i < 3; ++i) maker.polygon({{0, 0, 0}, {2, 0, 0}, {0, 1, 0}});
  maker.polygon({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  maker.polygon({{0, 0, 0}, {0, 0, 0}, {2, 0, 0}});
  maker.polygon({{0, 0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0, 0}, {2, 0, 0}});
  maker.polygon({{0, 0, 0}, {std::numeric_limits<double>::infinity(), 0, 0}, {2, 0, 0}});
  const auto [p, report] = mesh(maker, 0.5);
  EXPECT_EQ(report.duplicate_faces, 2u);
  EXPECT_EQ(report.degenerate_faces, 2u);
  EXPECT_EQ(report.non_finite_faces, 2u);
  EXPECT_NEAR(surface_area(p), 1, kRounding);
  expect_sound(p);
}

TEST(BuildPatches, ConcavePolygonsAndHolesOnDoubledEdgesAreRight) {
  SceneMaker maker;
  // L of area 3; ring of area 16 - 4 with its hole joined by a doubled edge; the same, wound clockwise.
  maker.polygon({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}});
  const std::vector<Vec3> ring{{0, 0, 3}, {4, 0, 3}, {4, 4, 3}, {0, 4, 3}, {0, 0, 3},
                               {1, 1, 3}, {1, 3, 3}, {3, 3, 3}, {3, 1, 3}, {1, 1, 3}};
  maker.polygon(ring);
  std::vector<Vec3> turned(ring.rbegin(), ring.rend());
  for (Vec3& x : turned) x.z = 6;
  maker.polygon(turned);
  const auto [p, report] = mesh(maker, 0.7);
  expect_sound(p);
  EXPECT_NEAR(surface_area(p), 3 + 12 + 12, 27 * kRounding);
  EXPECT_EQ(report.planar_regions, 3u);
  for (std::size_t i = 0; i < p.patch_count(); ++i) {
    if (p.side[i] != kFront) continue;
    const Vec3 x = p.vertices[p.corners[p.triangle[i]][0]] + p.origin;
    EXPECT_EQ(p.normal[i].z > 0, x.z < 5);  // winding survives
  }
}

TEST(BuildPatches, AWindowThatLiesOnItsWallIsCutOutOfIt) {
  for (const bool turned : {false, true}) {
    SceneMaker maker;
    const MaterialId wall = maker.material("wall"), glass = maker.material("glass");
    maker.edit(glass).kind = MaterialKind::glass;
    maker.polygon({{0, 0, 0}, {5, 0, 0}, {5, 0, 3}, {0, 0, 3}}, wall);
    if (turned)
      maker.polygon({{1, 0, 1}, {1, 0, 2}, {3, 0, 2}, {3, 0, 1}}, glass);
    else
      maker.polygon({{1, 0, 1}, {3, 0, 1}, {3, 0, 2}, {1, 0, 2}}, glass);
    const auto [p, report] = mesh(maker, 0.5);
    expect_sound(p);
    EXPECT_EQ(report.overlapping_regions, 1u);
    EXPECT_NEAR(surface_area(p), 15, 15 * kRounding);
    for (const Side side : {kFront, kBack}) {
      EXPECT_NEAR(area_of(p, glass, side), 2, 15 * kRounding);
      EXPECT_NEAR(area_of(p, wall, side), 13, 15 * kRounding);
    }
    EXPECT_EQ(edges_by_valence(p).count(3), 0u);
  }
}

TEST(BuildPatches, ALampInACeilingThatFacesUpKeepsTheFloorAboveIt) {
  SceneMaker maker;
  const MaterialId floor = maker.material("floor above"), lamp = maker.material("lamp");
  maker.edit(lamp).exitance = Spectrum(100);
  maker.polygon({{0, 0, 0}, {5, 0, 0}, {5, 3, 0}, {0, 3, 0}}, floor);  // front up
  maker.polygon({{1, 1, 0}, {1, 2, 0}, {3, 2, 0}, {3, 1, 0}}, lamp);   // front down
  const PatchSet p = mesh(maker, 0.5).patches;
  expect_sound(p);
  double up = 0, down = 0;
  for (PatchId i{std::size_t{0}}; i.value < p.patch_count(); ++i.value)
    if (p.material(i) == lamp) (p.normal[i].z > 0 ? up : down) += p.area[i];
  EXPECT_EQ(up, 0);
  EXPECT_NEAR(down, 2, 15 * kRounding);
}

/// A ceiling of 4 x 4 m and a smaller panel over it, both looking up; numbers that single precision does not hold.
SceneMaker ceiling_and_panel(double gap, MaterialId& ceiling, MaterialId& panel, double from = 1.1, double to = 3.1) {
  SceneMaker maker;
  ceiling = maker.material("ceiling"), panel = maker.material("panel");
  maker.polygon({{0, 0, 2.7}, {4, 0, 2.7}, {4, 4, 2.7}, {0, 4, 2.7}}, ceiling);
  const double z = 2.7 + gap;
  maker.polygon({{from, from, z}, {to, from, z}, {to, to, z}, {from, to, z}}, panel);
  return maker;
}

TEST(BuildPatches, SheetsFurtherApartThanTheToleranceStayTwo) {
  // 6e-7 of the 5.7 m that the ceiling is, on either side.
  for (const double gap : {-1e-3, -1e-5, 1e-5, 1e-3})
    for (const bool same_size : {false, true}) {
      SCOPED_TRACE(::testing::Message() << "gap " << gap << (same_size ? ", same size" : ""));
      MaterialId ceiling, panel;
      SceneMaker maker =
          same_size ? ceiling_and_panel(gap, ceiling, panel, 0, 4) : ceiling_and_panel(gap, ceiling, panel);
      const auto [p, report] = mesh(maker, 0.5);
      EXPECT_EQ(t_vertices(p), 0u);
      for (const Side side : {kFront, kBack}) {
        EXPECT_NEAR(area_of(p, ceiling, side), 16, 16 * kRounding);
        EXPECT_NEAR(area_of(p, panel, side), same_size ? 16 : 4, 16 * kRounding);
      }
    }
}

TEST(BuildPatches, SheetsInOnePlaneAreJoinedStill) {
  for (const double gap : {0.0, 5e-9, 1e-7, 1e-6}) {
    MaterialId ceiling, panel;
    SceneMaker maker = ceiling_and_panel(gap, ceiling, panel);
    const auto [p, report] = mesh(maker, 0.5);
    expect_sound(p);
    EXPECT_NEAR(surface_area(p), 16, 16 * kRounding);
    EXPECT_GT(report.overlapping_regions, 0u);
  }
}

TEST(BuildPatches, SheetsThatAreJoinedShowTheOutermostOnEachSide) {
  for (const double gap : {-1e-6, 1e-6})
    for (const bool is_glass : {false, true}) {
      SCOPED_TRACE(::testing::Message() << gap << (is_glass ? " glass" : ""));
      MaterialId ceiling, panel;
      SceneMaker maker = ceiling_and_panel(gap, ceiling, panel);
      if (is_glass) maker.edit(panel).kind = MaterialKind::glass;
      MeshReport report;
      const FaceComplex complex = clean(maker.scene(), kTolerances[0], report);
      const std::vector<PlaneGroup> groups = group_by_plane(complex);
      ASSERT_EQ(groups.size(), 1u);
      const Covering covering(complex, groups[0], maker.scene().materials);
      const auto found = covering.at(groups[0].plane.flatten(Vec3{0.01, 0.02, 0}), 0.01);
      ASSERT_TRUE(found);
      const bool panel_above = !is_glass && (gap > 0) == (groups[0].plane.n.z > 0);
      const bool panel_below = !is_glass && !panel_above;
      EXPECT_EQ(found->sheet.material_above == panel, panel_above);
      EXPECT_EQ(found->sheet.material_below == panel, panel_below);
    }
}

TEST(BuildPatches, APaneBeforeAWallDoesNotOpenIt) {
  for (const double gap : {1e-7, 1e-6, 1e-4}) {
    MaterialId wall, pane;
    SceneMaker maker = ceiling_and_panel(gap, wall, pane);
    maker.edit(pane).kind = MaterialKind::glass;
    const PatchSet p = mesh(maker, 0.5).patches;
    for (const Side side : {kFront, kBack}) EXPECT_NEAR(area_of(p, wall, side), 16, 16 * kRounding) << gap;
  }
}

TEST(BuildPatches, AMirrorOrADiffuserOnAWallHidesIt) {
  for (const MaterialKind kind : {MaterialKind::mirror, MaterialKind::diffuser})
    for (const double gap : {0.0, 1e-7, 1e-6}) {
      MaterialId wall, sheet;
      SceneMaker maker = ceiling_and_panel(gap, wall, sheet);
      maker.edit(sheet).kind = kind;
      const PatchSet p = mesh(maker, 0.5).patches;
      for (const Side side : {kFront, kBack}) {
        EXPECT_NEAR(area_of(p, wall, side), 12, 16 * kRounding) << gap;
        EXPECT_NEAR(area_of(p, sheet, side), 4, 16 * kRounding) << gap;
      }
    }
}

TEST(BuildPatches, SolidsThatShareAWallInPartHaveItOnce) {
  SceneMaker maker;
  maker.box({0, 0, 0}, {2, 2, 2});
  maker.box({2, 0.5, 0}, {4, 1.5, 1});
  const PatchSet p = mesh(maker, 0.5).patches;
  expect_sound(p);
  EXPECT_NEAR(surface_area(p), 24 + 2 * (2 * 1 + 2 * 1 + 1) - 1, 40 * kRounding);
}

TEST(BuildPatches, JoinsCoplanarFacesOfOneMaterialToOneRegion) {
  SceneMaker maker;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) {
      const double x = 0.1 * i, y = 0.1 * j;
      maker.polygon({{x, y, 0}, {x + 0.1, y, 0}, {x + 0.1, y + 0.1, 0}, {x, y + 0.1, 0}});
    }
  const auto [p, report] = mesh(maker, 2);
  EXPECT_NEAR(surface_area(p), 1, kRounding);
  expect_sound(p);
  EXPECT_EQ(report.planar_regions, 1u);
  EXPECT_EQ(p.triangle_count(), 2u);  // vertices that nothing needs are gone
}

TEST(BuildPatches, KeepsTheWindingOfEachFaceOfAPlane) {
  SceneMaker maker;
  maker.polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  maker.polygon({{1, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 0, 0}});  // front down
  const PatchSet p = mesh(maker, 0.4).patches;
  expect_sound(p);
  for (std::size_t i = 0; i < p.patch_count(); ++i) {
    double x = p.origin.x;
    for (const VertexId v : p.corners[p.triangle[i]]) x += p.vertices[v].x / 3;
    if (p.side[i] == kFront) {
      EXPECT_EQ(p.normal[i].z > 0, x < 1);
    }
  }
}

TEST(BuildPatches, CurvedSurfacesKeepTheirTriangles) {
  SceneMaker maker;
  const int n = 48;
  const auto at = [&](int i, int j) {
    const double theta = std::numbers::pi * j / 24, phi = 2 * std::numbers::pi * (i % n) / n;
    return Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 24; ++j) {
      if (j > 0) maker.polygon({at(i, j), at(i, j + 1), at(i + 1, j)});
      if (j < 23) maker.polygon({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  const auto [p, report] = mesh(maker, 0.5);
  expect_sound(p);
  EXPECT_EQ(edges_by_valence(p).size(), 1u);
  for (const Vec3& v : p.vertices) EXPECT_NEAR(length(v), 1, 1e-8);  // no vertex off the model's own
  EXPECT_EQ(p.triangle_count(), static_cast<std::size_t>(2 * n * 23));
}

TEST(BuildPatches, AQuadOutOfPlaneBecomesTwoFacets) {
  SceneMaker maker;
  maker.polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.2}, {0, 1, 0}});
  const auto [p, report] = mesh(maker, 5);
  EXPECT_EQ(report.planar_regions, 2u);
  expect_sound(p);
}

TEST(BuildPatches, EndsOnNeedlesAndNearlyTouchingLines) {
  SceneMaker maker;
  maker.polygon({{0, 0, 0}, {10, 0, 0}, {10, 1e-4, 0}});
  maker.polygon({{0, 0, 1}, {10, 0, 1}, {10, 8, 1}, {5, 1e-5, 1}});  // a notch that almost reaches the other side
  maker.polygon({{0, 0, 2}, {10, 0, 2}, {0, 1e-3, 2}});
  for (int i = 0; i < 40; ++i) maker.polygon({{0, 0, 3}, {10, 0.001 * i, 3}, {10, 0.001 * (i + 1), 3}});
  maker.polygon({{3, -1, -1}, {3.0001, 2, -1}, {3, 2, 5}});  // a blade through all of them
  const auto [p, report] = mesh(maker, 0.5);
  EXPECT_LT(p.triangle_count(), 20'000u);
  EXPECT_LE(report.longest_edge, 0.5 * (1 + 1e-9));
  EXPECT_EQ(t_vertices(p), 0u);
}

TEST(BuildPatches, KeepsDetailAMillionTimesSmallerThanTheModel) {
  SceneMaker maker;
  maker.polygon({{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {0, 100, 0}});
  const double s = 1e-4;
  maker.box({50, 50, 1}, {50 + s, 50 + s, 1 + s}, maker.material("grain"));
  const PatchSet p = mesh(maker, 20).patches;
  // The grid of 2^-32 of the model is 0.03 um there; the grain's edge is 100 um.
  EXPECT_NEAR(area_of(p, MaterialId{std::size_t{1}}, kFront), 6 * s * s, 6 * s * s * 2e-3);
}

TEST(BuildPatches, AnyTangleOfFacesGivesASoundMesh) {
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    RandomStream random(seed, 1);
    SceneMaker maker;
    const std::array<MaterialId, 3> materials{maker.material("a"), maker.material("b"), maker.material("glass")};
    maker.edit(materials[2]).kind = MaterialKind::glass;
    const auto on_grid = [&] { return std::floor(random.uniform() * 5); };
    for (int i = 0; i < 30; ++i) {
      const MaterialId m = materials[static_cast<std::size_t>(random.uniform() * 3)];
      const auto point = [&]() -> Vec3 {
        // Anywhere; all in a few planes; on a grid, where everything touches everything.
        if (seed % 3 == 0) return {random.uniform(), random.uniform(), random.uniform()};
        return {on_grid(), on_grid(), seed % 3 == 1 ? i % 3 : on_grid()};
      };
      if (i % 3 == 0) {
        const Vec3 a = point();
        maker.box(a, a + Vec3{1 + on_grid(), 1 + on_grid(), 1 + on_grid()}, m);
      } else if (i % 3 == 1) {
        maker.polygon({point(), point(), point(), point(), point()}, m);
      } else {
        maker.polygon({point(), point(), point()}, m);
      }
    }
    const auto [p, report] = build_patches(maker.scene());
    EXPECT_EQ(t_vertices(p), 0u) << "seed " << seed;
    EXPECT_EQ(coincident_triangles(p), 0u) << "seed " << seed;
    EXPECT_LE(report.longest_edge, report.max_element * (1 + 1e-9)) << "seed " << seed;
    for (std::size_t t = 0; t < p.triangle_count(); ++t)
      EXPECT_EQ(p.front_material(TriangleId{t}).lets_rays_pass(), p.side_material[t][kBack] == materials[2])
          << "glass owns both sides";
    make_lightmap(p);
  }
}

TEST(BuildPatches, AModelRoundedToMillimetresIsTakenWithAWiderTolerance) {
  // Walls, slabs and boxes turned by some degrees on each other, all corners rounded to 1 mm in 20 m.
  SceneMaker maker;
  for (int i = 0; i < 12; ++i) maker.box({0.7 * i, 0.5 * i, 0}, {0.7 * i + 8, 0.5 * i + 10, 3.0 + (i % 3)});
  const double angle = 0.3;
  for (Vec3& v : maker.scene().polygons.vertices) {
    const Vec3 turned{std::cos(angle) * v.x - std::sin(angle) * v.y, std::sin(angle) * v.x + std::cos(angle) * v.y,
                      v.z};
    v = {std::round(turned.x * 1e3) / 1e3, std::round(turned.y * 1e3) / 1e3, turned.z};
  }
  const auto [p, report] = build_patches(maker.scene());
  EXPECT_EQ(t_vertices(p), 0u);
  EXPECT_LT(p.triangle_count(), 30'000u);
}

TEST(BuildPatches, RefusesWhatHasNoSurfaceAndSaysWhy) {
  SceneMaker maker;
  maker.scene().file = "empty.obj";
  try {
    build_patches(maker.scene());
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("empty.obj: no face"), std::string::npos) << e.what();
  }
  maker.polygon({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}});
  maker.polygon({{0, 0, 0}, {std::nan(""), 1, 1}, {2, 2, 2}});
  try {
    build_patches(maker.scene());
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("2 read (1 with"), std::string::npos) << e.what();
  }
}

TEST(BuildPatches, RefusesAnElementSizeOfTooManyTriangles) {
  SceneMaker maker;
  maker.box({0, 0, 0}, {100, 100, 3});
  EXPECT_THROW(mesh(maker, 1e-3), InputError);
  for (const double bad : {0.0, -1.0, std::nan("")}) EXPECT_THROW(mesh(maker, bad), InputError);
}

}  // namespace
}  // namespace clerestory
