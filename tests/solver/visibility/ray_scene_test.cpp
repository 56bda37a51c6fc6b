#include "solver/visibility/ray_scene.h"

#include <gtest/gtest.h>

#include "solver/model/random_stream.h"
#include "solver/sampling/unit_square.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using test::PatchBuilder;
using test::two_sided;

TEST(RayScene, MeetsTheNearestTriangleOnTheSideItFaces) {
  PatchBuilder b;
  b.rectangle({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}).rectangle({-1, -1, 2}, {2, 0, 0}, {0, 2, 0});
  const PatchSet patches = two_sided(b.build());
  const RayScene rays(patches);
  const Hit up = rays.first_hit(patches, {{0.3, 0.1, 0}, {0, 0, 1}});
  ASSERT_TRUE(up.patch.valid());
  EXPECT_NEAR(up.distance, 1, 1e-6);
  EXPECT_EQ(patches.side[up.patch], kBack);  // fronts look up; the ray comes from below
  const Hit down = rays.first_hit(patches, {{0.3, 0.1, 3}, {0, 0, -1}});
  ASSERT_TRUE(down.patch.valid());
  EXPECT_EQ(patches.side[down.patch], kFront);
  EXPECT_NEAR(patches.corner_positions(down.patch)[0].z, 2, 1e-12);
  EXPECT_TRUE(rays.first_hit(patches, {{0, 0, 3}, {0, 0, 1}}).escaped());
}

TEST(RayScene, PacketsAndSingleRaysMeetTheSamePatches) {
  const PatchSet patches = test::room_of_2160_patches().build();
  const RayScene rays(patches);
  std::vector<Ray> bundle;
  for (std::uint32_t k = 0; k < 1000; ++k) {  // not a multiple of 16
    const auto u = sobol4(k, 3);
    bundle.push_back({{2.7, 0.5, 1.4}, sphere_direction(u[0], u[1])});
  }
  std::vector<Hit> hits(bundle.size());
  rays.first_hits(patches, bundle, hits);
  for (std::size_t k = 0; k < bundle.size(); ++k) {
    const Hit single = rays.first_hit(patches, bundle[k]);
    EXPECT_EQ(hits[k].patch.value, single.patch.value);
    EXPECT_NEAR(hits[k].distance, single.distance, 1e-6 * single.distance);  // both of float
  }
}

TEST(RayScene, SegmentsBetweenVisiblePointsAreFreeAndOthersAreNot) {
  const PatchSet patches = test::room_of_2160_patches().build();
  const RayScene rays(patches);
  SegmentPacket segments;
  std::array<bool, 16> expected{};
  for (int k = 0; k < 16; ++k) {
    const auto u = sobol4(static_cast<std::uint32_t>(k), 4);
    const Ray ray{{2.7, 0.5, 1.4}, sphere_direction(u[0], u[1])};
    const double distance = rays.first_hit(patches, ray).distance;
    expected[static_cast<std::size_t>(k)] = k % 2 == 0;
    segments.set(k, ray.origin, ray.origin + ray.direction * (distance * (k % 2 == 0 ? 0.999 : 1.001)));
  }
  const unsigned visible = rays.visible16(segments);
  for (std::size_t k = 0; k < 16; ++k) EXPECT_EQ((visible >> k & 1) == 1, expected[k]) << k;
  EXPECT_EQ(rays.visible16(segments, 0x0001), 0x0001);
}

TEST(RayScene, GlassTakesItsShareOnceForEachPane) {
  PatchBuilder b;
  b.rectangle({-1, -1, 3}, {2, 0, 0}, {0, 2, 0});
  PatchSet patches = b.build();
  Material glass;
  glass.kind = MaterialKind::glass;
  glass.transmittance = {0.8, 0.7, 0.5};
  patches.materials.push_back(glass);
  const auto pane = [&](double z) {
    const std::size_t v = patches.vertices.size();
    for (const Vec3& p : {Vec3{-1, -1, z}, Vec3{1, -1, z}, Vec3{1, 1, z}, Vec3{-1, 1, z}})
      patches.vertices.push_back(p);
    for (const auto& [i, j, k] : {std::array{0u, 1u, 2u}, std::array{0u, 2u, 3u}}) {
      patches.corners.push_back({VertexId{v + i}, VertexId{v + j}, VertexId{v + k}});
      patches.side_material.push_back(
          {MaterialId{patches.materials.size() - 1}, MaterialId{patches.materials.size() - 1}});
      patches.side_surface.push_back({SurfaceId{0}, SurfaceId{0}});
    }
  };
  pane(1), pane(2);
  patches = two_sided(patches);
  const RayScene rays(patches);
  ASSERT_TRUE(rays.has_glass());
  for (const double x : {0.3, 0.0}) {  // the second on the shared edge of each pane's two triangles
    const Hit hit = rays.first_hit(patches, {{x, x, 0}, {0, 0, 1}});
    ASSERT_TRUE(hit.patch.valid());
    EXPECT_NEAR(hit.distance, 3, 1e-6);
    EXPECT_NEAR(hit.transmittance[0], 0.64, 1e-12);
    EXPECT_NEAR(hit.transmittance[1], 0.49, 1e-12);
    EXPECT_NEAR(hit.transmittance[2], 0.25, 1e-12);
    EXPECT_NEAR(rays.transmittance({x, x, 0}, {x, x, 1.5})[0], 0.8, 1e-12);
  }
  EXPECT_TRUE(rays.transmittance({0, 0, 0}, {0, 0, 4}).is_black());

  // In packets: past the panes, through one of them, through both, through their shared edges.
  std::vector<Ray> bundle;
  SegmentPacket segments;
  for (std::uint32_t k = 0; k < 16; ++k) {
    const auto u = sobol4(k, 9);
    const double x = k % 4 == 3 ? 0 : 4 * u[0] - 2;
    bundle.push_back({{x, x, 0}, {0, 0, 1}});
    segments.set(static_cast<int>(k), {x, x, 0}, {x, x, 0.5 + 2 * u[1]});
  }
  std::vector<Hit> hits(bundle.size());
  rays.first_hits(patches, bundle, hits);
  const unsigned met = rays.meets_glass(segments, 0x7fff);
  unsigned seen = 0;
  for (std::size_t k = 0; k < 16; ++k) {
    EXPECT_EQ(hits[k].transmittance[0], rays.first_hit(patches, bundle[k]).transmittance[0]) << k;
    if (k < 15 && rays.glass_transmittance(segments.from[k], segments.to[k])[0] < 1) seen |= 1u << k;
  }
  EXPECT_EQ(met, seen);
  EXPECT_NE(seen, 0u);
  EXPECT_NE(seen, 0x7fffu);
}

TEST(RayScene, NoRayLeavesAClosedRoomAtAnyScale) {
  for (const double scale : {1e-3, 1.0, 1e4}) {
    test::RoomWithBlocks room = test::room_of_2160_patches();
    room.scale = scale;
    const PatchSet patches = room.build();
    const RayScene rays(patches);
    int lost = 0;
    for (std::uint32_t k = 0; k < 200'000; ++k) {
      const std::size_t i = k % patches.patch_count();
      const auto u = sobol4(k, i);
      const Frame frame(patches.normal[i]);
      const Vec3 start = point_on_triangle(patches.corner_positions(PatchId{i}), u[2], u[3]) + frame.n * rays.lift();
      const Hit hit = rays.first_hit(patches, {start, cosine_direction(frame, u[0], u[1])});
      lost += !hit.patch.valid();
    }
    EXPECT_EQ(lost, 0) << "scale " << scale;
  }
}

}  // namespace
}  // namespace clerestory
