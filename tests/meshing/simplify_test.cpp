#include "meshing/simplify.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "meshing/surface_distance.h"
#include "solver/model/parallel.h"
#include "tests/meshing/mesh_checks.h"

namespace clerestory {
namespace {

using namespace testing;
constexpr double kPi = std::numbers::pi;

/// A closed tube along x, its end caps fans around the axis.
void tube(SceneMaker& maker, const Vec3& from, double length, double radius, int facets, MaterialId m) {
  const auto at = [&](int k, double x) {
    const double angle = 2 * kPi * k / facets;
    return from + Vec3{x, radius * std::sin(angle), radius * std::cos(angle)};
  };
  for (int k = 0; k < facets; ++k) {
    maker.polygon({at(k, 0), at(k, length), at(k + 1, length), at(k + 1, 0)}, m);
    maker.polygon({from, at(k, 0), at(k + 1, 0)}, m);
    maker.polygon({from + Vec3{length, 0, 0}, at(k + 1, length), at(k, length)}, m);
  }
}

/// A room with a rail of 40 mm.
struct RailInRoom : SceneMaker {
  MaterialId rail;
  explicit RailInRoom(int facets = 96, double radius = 0.02) {
    box({0, 0, 0}, {4, 3, 2.5});
    rail = material("steel");
    tube(*this, {1, 1, 1}, 2, radius, facets, rail);
  }
};

MeshedScene mesh(SceneMaker& maker, std::optional<double> detail, double max_element = 0.5) {
  return build_patches(maker.scene(), {.max_element = max_element, .detail = detail});
}

std::size_t triangles_of(const PatchSet& p, MaterialId m) {
  std::size_t count = 0;
  for (const auto& sides : p.side_material) count += sides[0] == m;
  return count;
}

TEST(Simplify, MergesFacetsOfARailAndStaysWithinTheBound) {
  RailInRoom maker;
  const double detail = 0.001;
  const MeshedScene whole = mesh(maker, 0.0), simple = mesh(maker, detail);
  EXPECT_EQ(whole.report.simplified_parts, 0u);
  EXPECT_EQ(simple.report.simplified_parts, 1u);
  EXPECT_GT(simple.report.simplified_faces, 2u * 96u) << "of 384";
  EXPECT_LT(triangles_of(simple.patches, maker.rail), triangles_of(whole.patches, maker.rail));
  EXPECT_GT(simple.report.simplified_by, 0.0001);
  EXPECT_LE(simple.report.simplified_by, detail);
  const PatchSet& p = simple.patches;
  EXPECT_EQ(t_vertices(p), 0u);
  EXPECT_EQ(coincident_triangles(p), 0u);
  for (std::size_t t = 0; t < p.triangle_count(); ++t) {
    if (p.side_material[t][0] != maker.rail) continue;
    // Middles of facets are where they are nearest to the axis.
    Vec3 middle, n = cross(p.vertices[p.corners[t][1]] - p.vertices[p.corners[t][0]],
                           p.vertices[p.corners[t][2]] - p.vertices[p.corners[t][0]]);
    for (const VertexId v : p.corners[t]) middle += (p.vertices[v] + p.origin) / 3;
    if (std::abs(normalized(n).x) > 0.5) continue;
    const double off = std::hypot(middle.y - 1, middle.z - 1);
    EXPECT_LE(off, 0.02 + 1e-6);
    EXPECT_GE(off, 0.02 - detail - 1e-6);
    const Vec3 radial = normalized({0, middle.y - 1, middle.z - 1});
    EXPECT_GT(dot(normalized(n), radial), std::cos(16 * kPi / 180)) << "wound outwards, turned by 15 degrees at most";
  }
}

TEST(Simplify, TheDefaultGoesByTheElements) {
  RailInRoom maker;
  const auto by_default = [&](double max_element) {
    return build_patches(maker.scene(), {.max_element = max_element, .target_triangles = 300}).report;
  };
  const MeshReport coarse = by_default(1), fine = by_default(0.05), huge = by_default(1000);
  EXPECT_GT(coarse.simplified_faces, 100u);
  EXPECT_LE(coarse.simplified_by, 1.0 / 512);
  EXPECT_LE(fine.simplified_by, 0.05 / 512);
  EXPECT_LT(fine.simplified_faces, coarse.simplified_faces);
  EXPECT_LE(huge.simplified_by, 0.005) << "elements as long as 300 triangles have them are 1 m";
}

TEST(Simplify, LeavesAloneWhatLightSees) {
  const auto simplified = [](SceneMaker& maker, double detail) { return mesh(maker, detail).report.simplified_faces; };
  RailInRoom column(64, 0.3);
  EXPECT_EQ(simplified(column, 0.002), 0u) << "facets of 29 mm";
  RailInRoom glowing;
  glowing.edit(glowing.rail).exitance = Spectrum(10);
  EXPECT_EQ(simplified(glowing, 0.001), 0u) << "a lamp keeps its area";
  RailInRoom glass;
  glass.edit(glass.rail).kind = MaterialKind::glass;
  EXPECT_EQ(simplified(glass, 0.001), 0u);
  RailInRoom nested;
  tube(nested, {0.5, 1, 1}, 3, 0.0205, 96, nested.material("sleeve"));
  EXPECT_EQ(simplified(nested, 0.001), 0u) << "fine facets half a millimetre apart";
  SceneMaker boxes;
  boxes.box({0, 0, 0}, {4, 3, 2.5});
  boxes.box({1, 1, 1}, {1.001, 1.001, 2});
  EXPECT_EQ(simplified(boxes, 0.01), 0u) << "nothing about a box is bent smoothly";
}

TEST(Simplify, WhatTouchesAFlatSideStillDoes) {
  // A plank with rounded edges lies on the floor: no light gets under it, before or after.
  SceneMaker maker;
  maker.box({0, 0, 0}, {4, 3, 2.5});
  const MaterialId wood = maker.material("wood");
  std::vector<Vec3> profile = {{1, 1, 0}, {1, 1.5, 0}};
  for (const double side : {0.0, 1.0})
    for (int k = 0; k <= 24; ++k) {
      const double angle = (side + k / 24.0) * kPi / 2;
      profile.push_back({1, (side == 0 ? 1.48 : 1.02) + 0.02 * std::cos(angle), 0.03 + 0.02 * std::sin(angle)});
    }
  const std::size_t n = profile.size();
  const Vec3 along{2, 0, 0};
  std::vector<Vec3> far;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 &a = profile[k], &b = profile[(k + 1) % n];
    maker.polygon({a, b, b + along, a + along}, wood);
    far.push_back(a + along);
  }
  maker.polygon({profile.rbegin(), profile.rend()}, wood);
  maker.polygon(far, wood);
  const auto under = [](const PatchSet& p) {
    double area = 0;
    for (std::size_t t = 0; t < p.triangle_count(); ++t) {
      Vec3 middle;
      bool low = true;
      for (const VertexId v : p.corners[t]) {
        middle += (p.vertices[v] + p.origin) / 3;
        low = low && std::abs((p.vertices[v] + p.origin).z) < 1e-6;
      }
      if (low && middle.x > 1 && middle.x < 3 && middle.y > 1 && middle.y < 1.5) area += triangle_area(p, t);
    }
    return area;
  };
  const MeshedScene whole = mesh(maker, 0.0), simple = mesh(maker, 0.002);
  EXPECT_GT(simple.report.simplified_faces, 40u);
  EXPECT_EQ(coincident_triangles(simple.patches), 0u);
  EXPECT_NEAR(under(simple.patches), 1, 1e-6);
  EXPECT_NEAR(under(whole.patches), 1, 1e-6);
}

TEST(Simplify, IsTheSameForAnyNumberOfThreads) {
  RailInRoom maker;
  for (int k = 0; k < 6; ++k) tube(maker, {1, 0.5 + 0.3 * k, 2}, 1, 0.01, 48, maker.rail);
  set_thread_count(1);
  const PatchSet one = mesh(maker, 0.001).patches;
  set_thread_count(4);
  const PatchSet four = mesh(maker, 0.001).patches;
  set_thread_count(0);
  EXPECT_EQ(one.corners, four.corners);
  ASSERT_EQ(one.vertices.size(), four.vertices.size());
  for (std::size_t v = 0; v < one.vertices.size(); ++v) EXPECT_EQ(one.vertices[v], four.vertices[v]);
}

TEST(SurfaceDistance, IsThatOfTheFarthestPoint) {
  const std::vector<TriangleCorners> low = {{Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                            {Vec3{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
  std::vector<TriangleCorners> high = low;
  for (auto& t : high)
    for (Vec3& p : t) p.z = 0.1;
  const auto found = farthest_distance(low, high, 0.12);
  ASSERT_TRUE(found);
  EXPECT_GE(*found, 0.1 - 1e-12);
  EXPECT_LE(*found, 0.12);
  EXPECT_FALSE(farthest_distance(low, high, 0.09));

  // Corners of the square lie on the frame; its middle is 0.4 from it.
  std::vector<TriangleCorners> frame;
  const std::array<Vec3, 4> outer{Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
      inner{Vec3{0.1, 0.1, 0}, {0.9, 0.1, 0}, {0.9, 0.9, 0}, {0.1, 0.9, 0}};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t l = (k + 1) % 4;
    frame.push_back({outer[k], outer[l], inner[l]});
    frame.push_back({outer[k], inner[l], inner[k]});
  }
  EXPECT_FALSE(farthest_distance(low, frame, 0.3));
  const auto hole = farthest_distance(low, frame, 0.5);
  ASSERT_TRUE(hole);
  EXPECT_GE(*hole, 0.4 - 1e-12);
  EXPECT_LE(*farthest_distance(frame, low, 0.1), 1e-12);
}

}  // namespace
}  // namespace clerestory
