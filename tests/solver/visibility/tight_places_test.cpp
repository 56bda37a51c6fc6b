// Surfaces nearer to each other than single precision can tell: rays there are in double, and pass none of them.

#include "solver/visibility/tight_places.h"

#include <cmath>

#include <gtest/gtest.h>

#include "solver/model/random_stream.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/ray_scene.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using test::PatchBuilder;
using test::two_sided;

/// Something far away, so that the scene's diameter is about `diameter` and rounding is that of its rim.
PatchBuilder& widen(PatchBuilder& b, double diameter) {
  const double x = diameter / 2 / std::sqrt(3.0);
  return b.rectangle({-x, -x, -x}, {0.01 * x, 0, 0}, {0, 0.01 * x, 0})
      .rectangle({x, x, x}, {0.01 * x, 0, 0}, {0, 0.01 * x, 0});
}

/// Two squares of 1 m over each other at z and z + gap, fronts up.
PatchSet two_sheets(double gap, double z, double diameter) {
  PatchBuilder b;
  b.rectangle({0, 0, z}, {1, 0, 0}, {0, 1, 0}, 3, 3).rectangle({-0.1, -0.1, z + gap}, {1.2, 0, 0}, {0, 1.2, 0}, 2, 2);
  return two_sided(widen(b, diameter).build());
}

TEST(TightPlaces, AreWhereAnotherSurfaceIsNearerThanTwoLifts) {
  const double lift = 1e-5;
  for (const double gap : {1e-7, 1e-6, 1.9e-5}) EXPECT_TRUE(TightPlaces(two_sheets(gap, 0.3, 20), lift).any()) << gap;
  for (const double gap : {2.1e-5, 1e-3}) EXPECT_FALSE(TightPlaces(two_sheets(gap, 0.3, 20), lift).any()) << gap;
  EXPECT_FALSE(TightPlaces(two_sheets(0, 0.3, 20), lift).any());  // faces alike in one plane
  const PatchSet sheets = two_sheets(1e-6, 0.3, 20);
  const TightPlaces tight(sheets, lift);
  EXPECT_TRUE(tight.contains({0.5, 0.5, 0.3}));
  EXPECT_TRUE(tight.contains({0.5, 0.5, 0.3 - 1.9e-5}));
  EXPECT_FALSE(tight.contains({0.5, 0.5, 0.3 - 2.1e-5}));
}

TEST(TightPlaces, AreFoundBesideAFaceThatIsFarAway) {
  // A face at 10,000 km makes a lift as long as a room, so that the whole of a room is tight; that must end, too.
  const double diameter = 2e7, lift = 5e-7 * diameter;
  const PatchSet patches = two_sheets(0.1, 0.3, diameter);
  const TightPlaces tight(patches, lift);
  EXPECT_TRUE(tight.any());
  EXPECT_TRUE(tight.contains({0.5, 0.5, 0.3}));
  EXPECT_TRUE(tight.contains({0.5, 0.5, 0.3 + 1.9 * lift}));
  EXPECT_FALSE(tight.contains({0.5, 0.5, 0.4 + 2.1 * lift}));
}

TEST(TightPlaces, AreNotTheCornersOfRoomsAndTheFacetsOfCurves) {
  EXPECT_FALSE(TightPlaces(two_sided(test::room_of_2160_patches().build()), 1e-5).any());
  PatchBuilder tube;  // of 36 strips, each turned by 10 degrees
  const auto at = [](int k) { return Vec3{std::cos(k * 10 * M_PI / 180), std::sin(k * 10 * M_PI / 180), 0}; };
  for (int k = 0; k < 36; ++k) tube.rectangle(at(k), at(k + 1) - at(k), {0, 0, 1});
  EXPECT_FALSE(TightPlaces(two_sided(tube.build()), 1e-5).any());
}

TEST(TightPlaces, AreTheEdgesOfSharpWedgesOnly) {
  for (const double degrees : {0.01, 0.1, 1.0, 5.0, 10.0, 30.0, 90.0}) {
    const double rise = std::tan(degrees * M_PI / 180);
    PatchBuilder b;
    b.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).rectangle({0, 0, 0}, {0, 1, 0}, {1, 0, rise});
    EXPECT_EQ(TightPlaces(two_sided(b.build()), 1e-5).any(), degrees < 5.7) << degrees;
  }
}

TEST(RaysInTightPlaces, MeetTheSheetThatIsFirstWhateverTheGap) {
  // Float at 5 to 50 m tells 0.5 to 4 um apart; the gaps go down to 2e-9 of the diameter.
  for (const double diameter : {20.0, 200.0})
    for (const double gap : {2e-9 * diameter, 1e-8 * diameter, 1e-7 * diameter, 5e-7 * diameter, 1e-6 * diameter}) {
      SCOPED_TRACE(testing::Message() << "diameter " << diameter << " m, gap " << gap << " m");
      const double z = 0.29 * diameter;
      const PatchSet patches = two_sheets(gap, z, diameter);
      const RayScene rays(patches);
      const auto height_of = [&](const Hit& hit) { return patches.corner_positions(hit.patch)[0].z; };
      for (std::uint32_t k = 0; k < 200; ++k) {
        const auto u = sobol4(k, 1);
        const Vec3 d = cosine_direction(Frame(Vec3{0, 0, 1}), u[0], 0.25 * u[1]);
        const Vec3 x{0.1 + 0.8 * u[2], 0.1 + 0.8 * u[3], 0};
        if (d.z < 1e-3) continue;
        // From below and from above, to the near one.
        const Hit up = rays.first_hit(patches, {x + Vec3{0, 0, z} - d * 0.5, d});
        ASSERT_TRUE(up.patch.valid());
        EXPECT_EQ(height_of(up), z);
        const Hit down = rays.first_hit(patches, {x + Vec3{0, 0, z + gap} + d * 0.5, -d});
        ASSERT_TRUE(down.patch.valid());
        EXPECT_EQ(height_of(down), z + gap);
        // From one to the other, and from there out.
        const Vec3 between = rays.off_surface(x + Vec3{0, 0, z}, {0, 0, 1});
        EXPECT_LT(between.z, z + gap);
        const Hit other = rays.first_hit(patches, {between, d});
        if (other.distance < 0.1) {
          EXPECT_EQ(height_of(other), z + gap);
        }
        EXPECT_FALSE(rays.visible(between, between + Vec3{0, 0, 0.2}));
        EXPECT_TRUE(rays.visible(rays.off_surface(x + Vec3{0, 0, z}, {0, 0, -1}), x + Vec3{0, 0, z - 0.2}));
        SegmentPacket segments;
        segments.set(0, between, between + Vec3{0, 0, 0.2});
        segments.set(1, rays.off_surface(x + Vec3{0, 0, z + gap}, {0, 0, 1}), x + Vec3{0, 0, z + 0.2});
        EXPECT_EQ(rays.visible16(segments, 3), 2);
      }
    }
}

TEST(RaysInTightPlaces, PacketsAndSingleRaysMeetTheSame) {
  const PatchSet patches = two_sheets(1e-6, 5.8, 20);
  const RayScene rays(patches);
  std::vector<Ray> bundle;
  for (std::uint32_t k = 0; k < 100; ++k) {
    const auto u = sobol4(k, 3);
    bundle.push_back({{0.5, 0.5, k % 2 ? 5.8 : 5}, sphere_direction(u[0], u[1])});
  }
  std::vector<Hit> hits(bundle.size());
  rays.first_hits(patches, bundle, hits);
  for (std::size_t k = 0; k < bundle.size(); ++k)
    EXPECT_EQ(hits[k].patch.value, rays.first_hit(patches, bundle[k]).patch.value);
}

TEST(RaysInTightPlaces, CountEveryPaneOfGlassAndNoneBehindAWall) {
  for (const double gap : {5e-8, 1e-6, 1e-5, 1e-3}) {
    SCOPED_TRACE(testing::Message() << "gap " << gap << " m");
    PatchBuilder b;
    b.glass(0.6);
    b.rectangle({0, 0, 5}, {1, 0, 0}, {0, 1, 0}).rectangle({0, 0, 5 + gap}, {1, 0, 0}, {0, 1, 0});
    b.rectangle({2, 0, 5}, {1, 0, 0}, {0, 1, 0});
    b.material(0.5).rectangle({2, 0, 5 + gap}, {1, 0, 0}, {0, 1, 0});
    const PatchSet patches = two_sided(widen(b, 20).build());
    const RayScene rays(patches);
    EXPECT_NEAR(rays.first_hit(patches, {{0.3, 0.4, 4}, {0, 0, 1}}).transmittance[0], 0.36, 1e-9);
    EXPECT_NEAR(rays.transmittance({0.3, 0.4, 4}, {0.3, 0.4, 6})[0], 0.36, 1e-9);
    // Of the wall only the side with the pane before it is seen through the pane.
    const Hit through = rays.first_hit(patches, {{2.3, 0.4, 4}, {0, 0, 1}});
    EXPECT_EQ(patches.side[through.patch], kBack);
    EXPECT_NEAR(through.transmittance[0], 0.6, 1e-9);
    EXPECT_EQ(rays.first_hit(patches, {{2.3, 0.4, 6}, {0, 0, -1}}).transmittance[0], 1);
    EXPECT_NEAR(rays.transmittance(rays.off_surface({2.3, 0.4, 5 + gap}, {0, 0, -1}), {2.3, 0.4, 4})[0], 0.6, 1e-9);
    EXPECT_EQ(rays.transmittance(rays.off_surface({2.3, 0.4, 5 + gap}, {0, 0, 1}), {2.3, 0.4, 6})[0], 1);
  }
}

TEST(RaysInTightPlaces, AMirrorAHairBeforeAWallReflects) {
  for (const double gap : {5e-8, 1e-6, 1e-5, 1e-3}) {
    PatchBuilder b;
    b.mirror(0.9).rectangle({0, 0, 5}, {1, 0, 0}, {0, 1, 0});
    b.material(0.5).rectangle({0, 0, 5 + gap}, {1, 0, 0}, {0, 1, 0}).rectangle({0, 0, 4}, {1, 0, 0}, {0, 1, 0});
    const PatchSet patches = two_sided(widen(b, 20).build());
    const RayScene rays(patches);
    const Hit hit = rays.first_hit(patches, {{0.3, 0.4, 4.5}, {0, 0, 1}});
    ASSERT_TRUE(hit.patch.valid()) << gap;
    EXPECT_EQ(patches.corner_positions(hit.patch)[0].z, 4) << gap;
    EXPECT_NEAR(hit.transmittance[0], 0.9, 1e-12) << gap;
  }
}

TEST(BesideSurfaces, APointSeesTheSpaceThatItIsIn) {
  PatchBuilder b;
  b.rectangle({0, 0, 5.1}, {1, 0, 0}, {0, 1, 0}, 3, 3);
  const PatchSet patches = two_sided(widen(b, 20).build());
  const RayScene rays(patches);
  const Vec3 up{0, 0, 1}, down{0, 0, -1};
  const auto sees_up = [&](double h, const Vec3& n) {
    return rays.first_hit(patches, {rays.beside_surfaces({0.3, 0.4, 5.1 + h}, n), up}).escaped();
  };
  for (const double h : {1e-8, 1e-7, 1e-6, 1e-5, 1e-3})
    for (const Vec3& n : {up, down}) {
      EXPECT_TRUE(sees_up(h, n)) << h;
      EXPECT_FALSE(sees_up(-h, n)) << h;
    }
  EXPECT_TRUE(sees_up(0, up));
  EXPECT_FALSE(sees_up(0, down));
  const Vec3 in_the_air{0.3, 0.4, 5.2};
  EXPECT_EQ(rays.beside_surfaces(in_the_air, up), in_the_air);
}

TEST(BesideSurfaces, APointInAGapSeesTheGapOnly) {
  for (const double gap : {1e-7, 1e-6, 1e-5}) {
    const PatchSet patches = two_sheets(gap, 5.1, 20);
    const RayScene rays(patches);
    ASSERT_TRUE(rays.is_tight({0.3, 0.4, 5.1}));
    const auto first_from = [&](double h, const Vec3& n, const Vec3& d) {
      return rays.first_hit(patches, {rays.beside_surfaces({0.3, 0.4, 5.1 + h}, n), d});
    };
    const Vec3 up{0, 0, 1}, down{0, 0, -1};
    for (const double h : {0.0, gap / 2, gap}) {
      SCOPED_TRACE(::testing::Message() << "gap " << gap << " m, at " << h);
      const Vec3 n_up = h == gap ? down : up;  // into the gap
      EXPECT_LT(first_from(h, n_up, up).distance, 2e-5);
      EXPECT_LT(first_from(h, n_up, down).distance, 2e-5);
    }
    EXPECT_TRUE(first_from(gap, up, up).escaped());
    EXPECT_TRUE(first_from(0, down, down).escaped());
  }
}

}  // namespace
}  // namespace clerestory
