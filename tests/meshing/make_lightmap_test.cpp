#include "meshing/make_lightmap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/meshing/mesh_checks.h"

namespace clerestory {
namespace {

/// Way that the facets around point p face on the whole.
Vec3 mean_normal(const VertexLightmap& map, std::size_t p) {
  Vec3 sum;
  for (std::uint32_t s = map.sample_begin[p]; s < map.sample_begin[p + 1]; ++s)
    sum += map.sample_normal[s] * map.sample_weight[s];
  return normalized(sum);
}

using namespace testing;

PatchSet mesh(SceneMaker& maker, double max_element) {
  MeshOptions options;
  options.max_element = max_element;
  return build_patches(maker.scene(), options).patches;
}
/// Points at one place.
std::size_t points_at(const VertexLightmap& map, const Vec3& x) {
  std::size_t count = 0;
  for (const Vec3& p : map.position) count += length(p - x) < 1e-9;
  return count;
}

TEST(MakeLightmap, ASphereIsSmoothOnBothSides) {
  SceneMaker maker;
  const int n = 36;
  const auto at = [&](int i, int j) {
    const double theta = std::numbers::pi * j / 18, phi = 2 * std::numbers::pi * (i % n) / n;
    return Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 18; ++j) {
      if (j > 0) maker.polygon({at(i, j), at(i, j + 1), at(i + 1, j)});
      if (j < 17) maker.polygon({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  const PatchSet p = mesh(maker, 1);
  const VertexLightmap map = make_lightmap(p);
  EXPECT_EQ(map.position.size(), 2 * p.vertices.size());
  // Normals follow the sphere; facets of 10 degrees and their uneven fans leave a few degrees.
  for (std::size_t i = 0; i < map.position.size(); ++i)
    EXPECT_GT(std::abs(dot(mean_normal(map, i), normalized(map.position[i]))), std::cos(0.1));
}

TEST(MakeLightmap, ABoxIsPartedAtItsEdges) {
  SceneMaker maker;
  maker.box({0, 0, 0}, {2, 2, 2});
  const PatchSet p = mesh(maker, 0.6);
  const VertexLightmap map = make_lightmap(p);
  EXPECT_EQ(points_at(map, {1, 1, 1}), 6u);  // three faces, two sides
  // Coplanar neighbours share: within a face and a side there is one point for each vertex.
  std::set<std::array<double, 4>> places;
  for (std::size_t i = 0; i < map.position.size(); ++i) {
    const Vec3 n = mean_normal(map, i), x = map.position[i];
    EXPECT_NEAR(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 1, 1e-9);
    const double face = std::round(n.x) + 10 * std::round(n.y) + 100 * std::round(n.z);
    EXPECT_TRUE(places.insert({face, x.x, x.y, x.z}).second);
  }
}

TEST(MakeLightmap, CornersRunCounterClockwiseFromTheLitSide) {
  SceneMaker maker;
  maker.box({0, 0, 0}, {2, 1, 1});
  const PatchSet p = mesh(maker, 0.6);
  const VertexLightmap map = make_lightmap(p);
  for (std::size_t i = 0; i < p.patch_count(); ++i) {
    const auto expected = p.corner_positions(PatchId{i});
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(map.position[map.corners[i][k]], expected[k]);
    const Vec3 n = cross(expected[1] - expected[0], expected[2] - expected[0]);
    EXPECT_GT(dot(n, p.normal[i]), 0);
  }
}

TEST(MakeLightmap, APartitionPartsTheFloorItStandsOnButNotTheOneBelow) {
  SceneMaker maker;
  maker.polygon({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  maker.polygon({{0, -1, 0}, {0, 0.5, 0}, {0, 0.5, 1}, {0, -1, 1}});
  const PatchSet p = mesh(maker, 0.3);
  const VertexLightmap map = make_lightmap(p);
  std::size_t on_the_line = 0;
  for (const Vec3& v : p.vertices) {
    const Vec3 x = v + p.origin;
    if (std::abs(x.x) > 1e-9 || std::abs(x.z) > 1e-9) continue;
    ++on_the_line;
    if (x.y < 0.5 - 1e-9) EXPECT_EQ(points_at(map, v), 5u) << x.y;  // floor left and right, partition two, below one
    // At its end the floor goes on around the partition.
    else if (x.y < 0.5 + 1e-9)
      EXPECT_EQ(points_at(map, v), 4u);
    else
      EXPECT_EQ(points_at(map, v), 2u);
  }
  EXPECT_GT(on_the_line, 5u);
}

TEST(MakeLightmap, MaterialsAndRimsPart) {
  SceneMaker maker;
  const MaterialId other = maker.material("other");
  maker.polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  maker.polygon({{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}, other);
  const PatchSet p = mesh(maker, 0.4);
  const VertexLightmap map = make_lightmap(p);
  for (const Vec3& v : p.vertices)
    EXPECT_EQ(points_at(map, v), std::abs(v.x + p.origin.x - 1) < 1e-9 ? 4u : 2u);  // front and back never share
}

TEST(MakeLightmap, MixedWindingDoesNotPartASurface) {
  SceneMaker maker;
  maker.polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  maker.polygon({{1, 0, 0}, {1, 1, 0}, {2, 1, 0.1}, {2, 0, 0.1}});  // the other way round, 6 degrees
  const PatchSet p = mesh(maker, 0.4);
  const VertexLightmap map = make_lightmap(p);
  EXPECT_EQ(map.position.size(), 2 * p.vertices.size());
}

TEST(MakeLightmap, SamplesStartALittleInsideOfTheSurface) {
  SceneMaker maker;
  maker.box({0, 0, 0}, {2, 2, 2});
  const PatchSet p = mesh(maker, 0.5);
  const VertexLightmap map = make_lightmap(p);
  ASSERT_EQ(map.sample_position.size(), map.position.size());  // flat: one sample a point
  for (std::size_t i = 0; i < map.position.size(); ++i) {
    const Vec3 d = map.sample_position[i] - map.position[i];
    EXPECT_LT(length(d), 1e-3);                          // of elements of 0.5 m
    EXPECT_NEAR(dot(d, mean_normal(map, i)), 0, 1e-12);  // stays on the face
    const Vec3 s = map.sample_position[i];
    // Inside of its own face, never on one of the box's edges.
    const int on_faces = (std::abs(std::abs(s.x) - 1) < 1e-9) + (std::abs(std::abs(s.y) - 1) < 1e-9) +
                         (std::abs(std::abs(s.z) - 1) < 1e-9);
    EXPECT_EQ(on_faces, 1);
  }
}

TEST(MakeLightmap, SamplesOfASmoothRoofLieOnItsFacetsAndNotUnderThem) {
  // A flat eight-sided pyramid: its apex is one point. Between the facets' centroids it would sink into the roof.
  SceneMaker maker;
  const auto rim = [](int k) {
    const double turn = k * std::numbers::pi / 4;
    return Vec3{std::cos(turn), std::sin(turn), 0};
  };
  for (int k = 0; k < 8; ++k) maker.polygon({rim(k), rim(k + 1), {0, 0, 0.4}});
  const PatchSet p = mesh(maker, 2);
  const VertexLightmap map = make_lightmap(p);
  std::size_t apex = map.position.size();
  for (std::size_t i = 0; i < map.position.size(); ++i)
    if (length(map.position[i] + p.origin - Vec3{0, 0, 0.4}) < 1e-9 && mean_normal(map, i).z > 0) apex = i;
  ASSERT_LT(apex, map.position.size());
  ASSERT_EQ(map.sample_begin[apex + 1] - map.sample_begin[apex], 8u);
  double weights = 0;
  for (std::uint32_t s = map.sample_begin[apex]; s < map.sample_begin[apex + 1]; ++s) {
    const Vec3 d = map.sample_position[s] - map.position[apex];
    EXPECT_NEAR(dot(d, map.sample_normal[s]), 0, 1e-12);
    for (std::uint32_t other = map.sample_begin[apex]; other < map.sample_begin[apex + 1]; ++other)
      EXPECT_LT(dot(d, map.sample_normal[other]), 1e-12) << "above a facet of a convex roof";
    weights += map.sample_weight[s];
  }
  EXPECT_NEAR(weights, 1, 1e-12);
}

/// Each neighbour names the patch back, over an edge between the same two places.
void expect_mutual(const PatchSet& p, const VertexLightmap& map) {
  ASSERT_EQ(map.neighbour.size(), p.patch_count());
  for (std::uint32_t i = 0; i < p.patch_count(); ++i) {
    const auto here = p.corner_positions(PatchId{i});
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t q = map.neighbour[i][k];
      if (q == VertexLightmap::kNone) continue;
      const auto there = p.corner_positions(PatchId{q});
      int mutual = 0;
      for (std::size_t j = 0; j < 3; ++j)
        mutual += map.neighbour[q][j] == i && there[j] == here[(k + 1) % 3] && there[(j + 1) % 3] == here[k];
      EXPECT_EQ(mutual, 1) << "patch " << i << ", edge " << k;
    }
  }
}

TEST(MakeLightmap, EveryEdgeOfAClosedBoxHasANeighbourThatSeesTheSameRoom) {
  SceneMaker maker;
  maker.box({0, 0, 0}, {2, 1, 1});
  const PatchSet p = mesh(maker, 0.6);
  const VertexLightmap map = make_lightmap(p);
  expect_mutual(p, map);
  for (std::uint32_t i = 0; i < p.patch_count(); ++i)
    for (const std::uint32_t q : map.neighbour[i]) {
      ASSERT_NE(q, VertexLightmap::kNone);
      const auto looks_in = [&](std::uint32_t k) {
        const auto x = p.corner_positions(PatchId{k});
        return dot(x[0] + x[1] + x[2], p.normal[k]) < 0;  // the box stands around the origin
      };
      EXPECT_EQ(looks_in(i), looks_in(q));
    }
}

TEST(MakeLightmap, ARimTurnsOverToTheSheetsOwnBack) {
  SceneMaker maker;
  maker.polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  PatchSet p = mesh(maker, 0.4);
  const VertexLightmap map = make_lightmap(p);
  expect_mutual(p, map);
  std::size_t rims = 0;
  for (std::uint32_t i = 0; i < p.patch_count(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto x = p.corner_positions(PatchId{i});
      const Vec3 middle = (x[k] + x[(k + 1) % 3]) / 2;
      const bool on_rim = std::max(std::abs(middle.x), std::abs(middle.y)) > 0.5 - 1e-9;
      rims += on_rim;
      const std::uint32_t q = map.neighbour[i][k];
      ASSERT_NE(q, VertexLightmap::kNone);
      EXPECT_EQ(p.triangle[q] == p.triangle[i], on_rim);
      EXPECT_EQ(dot(p.normal[q], p.normal[i]), on_rim ? -1 : 1);
    }
  EXPECT_GE(rims, 2 * 4 * 3u);

  std::vector<bool> fronts(2 * p.triangle_count(), false);
  for (std::size_t t = 0; t < p.triangle_count(); ++t) fronts[2 * t + kFront] = true;
  make_patches(p, fronts);
  std::size_t open = 0;
  for (const auto& neighbour : make_lightmap(p).neighbour)
    open += static_cast<std::size_t>(std::count(neighbour.begin(), neighbour.end(), VertexLightmap::kNone));
  EXPECT_EQ(open, rims / 2) << "a back that takes no part is nobody's neighbour";
}

TEST(MakeLightmap, AFloorTurnsUpThePartitionThatStandsOnItAndRunsOnBelow) {
  SceneMaker maker;
  maker.polygon({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  maker.polygon({{0, -1, 0}, {0, 1, 0}, {0, 1, 1}, {0, -1, 1}});
  const PatchSet p = mesh(maker, 0.3);
  const VertexLightmap map = make_lightmap(p);
  expect_mutual(p, map);
  std::size_t on_the_line = 0;
  for (std::uint32_t i = 0; i < p.patch_count(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto x = p.corner_positions(PatchId{i});
      const auto on_line = [&](const Vec3& v) {
        return std::abs(v.x + p.origin.x) < 1e-9 && std::abs(v.z + p.origin.z) < 1e-9;
      };
      if (!on_line(x[k]) || !on_line(x[(k + 1) % 3])) continue;
      ++on_the_line;
      const Vec3 n = p.normal[i], m = p.normal[map.neighbour[i][k]];
      const double way = (x[0] + x[1] + x[2]).x / 3 + p.origin.x > 0 ? 1 : -1;  // from the line to a floor patch
      if (n.z > 0.5)
        EXPECT_NEAR(m.x, way, 1e-9) << "the partition's side that looks over this floor";
      else if (n.z < -0.5)
        EXPECT_NEAR(m.z, -1, 1e-9) << "below nothing stands";
      else
        EXPECT_NEAR(m.z, 1, 1e-9) << "from the partition down on the floor";
    }
  EXPECT_GE(on_the_line, 6 * 7u);
}

TEST(MakeLightmap, HalvedPatchesAreRefused) {
  SceneMaker maker;
  maker.box({0, 0, 0}, {1, 1, 1});
  PatchSet p = mesh(maker, 2);
  p.splits.resize(p.patch_count());
  EXPECT_THROW(make_lightmap(p), std::logic_error);
}

TEST(MakeLightmap, AveragesByArea) {
  SceneMaker maker;
  maker.box({0, 0, 0}, {2, 2, 2});
  const PatchSet p = mesh(maker, 0.5);
  VertexLightmap map = make_lightmap(p);
  Field E(p.patch_count(), 1);
  for (std::size_t i = 0; i < p.patch_count(); ++i) E.at(i, 0) = 3;
  average_to_points(p, E, map);
  for (const double e : map.E.value) EXPECT_NEAR(e, 3, 1e-12);
}

}  // namespace
}  // namespace clerestory
