#include "solver/evaluate/buried_points.h"

#include <gtest/gtest.h>

#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using Numbers = std::vector<std::size_t>;

/// Numbers of these points in patches of which only the first `lit` triangles take light, on their fronts.
Numbers buried(PatchSet patches, std::size_t lit, const std::vector<SensorPoint>& points) {
  std::vector<bool> wanted(2 * patches.triangle_count(), false);
  for (std::size_t t = 0; t < lit; ++t) wanted[2 * t + kFront] = true;
  make_patches(patches, wanted);
  const RayScene rays(patches);
  const Lights none;
  return buried_points({patches, rays, none}, points);
}

constexpr Vec3 kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};
constexpr std::size_t kBox = 12;  ///< triangles

/// A lit room of 4 x 4 x 3 m, and beside it another one of that size, wound inwards or outwards.
PatchSet two_rooms(bool inwards, bool walls_apart) {
  test::PatchBuilder b;
  b.surface("lit").box({0, 0, 0}, kX * 4, kY * 4, kZ * 3, {1, 1, 1}, true);
  const Vec3 o{5, 0, 0};
  b.surface("dark");
  if (!walls_apart) return b.box(o, kX * 4, kY * 4, kZ * 3, {1, 1, 1}, inwards).build();
  b.rectangle(o, kY * 4, kX * 4).rectangle(o + kZ * 3, kX * 4, kY * 4);  // floor and ceiling, fronts outside
  b.surface("walls").rectangle(o, kX * 4, kZ * 3).rectangle(o + kY * 4, kZ * 3, kX * 4);
  return b.rectangle(o, kZ * 3, kY * 4).rectangle(o + kX * 4, kY * 4, kZ * 3).build();
}
const std::vector<SensorPoint> kBothRooms = {{{2, 2, 0.8}, kZ}, {{7, 2, 0.8}, kZ}, {{7, 2, 2.9}, kZ}};

TEST(BuriedPoints, AreThoseThatSeeTheBacksOfASolidAround) {
  const PatchSet patches = test::room_of_2160_patches().build();
  const std::vector<SensorPoint> points{{{0.2, 0.2, 0.8}, kZ}, {{1.5, 1.8, 1.0}, kZ}, {{1.5, 1.8, 1.0}, -kX}};
  EXPECT_EQ(buried(patches, patches.triangle_count(), points), (Numbers{1, 2}));
}

TEST(BuriedPoints, InADarkRoomAreNone) {
  EXPECT_EQ(buried(two_rooms(true, false), kBox, kBothRooms), Numbers{});
  EXPECT_EQ(buried(two_rooms(false, true), kBox, kBothRooms), Numbers{}) << "wound outwards, of several surfaces";
  EXPECT_EQ(buried(two_rooms(false, false), kBox, kBothRooms), (Numbers{1, 2})) << "one surface: drawn as a solid";
}

TEST(BuriedPoints, InASlabAreThoseHoweverItIsWound) {
  for (const bool inwards : {true, false}) {
    test::PatchBuilder b;
    b.surface("room").box({0, 0, 0}, kX * 4, kY * 4, kZ * 3, {1, 1, 1}, true);
    b.surface("slab").box({0, 0, -0.31}, kX * 4, kY * 4, kZ * 0.3, {1, 1, 1}, inwards);
    EXPECT_EQ(buried(b.build(), kBox, {{{2, 2, -0.1}, kZ}, {{2, 2, 0.1}, kZ}}), Numbers{0}) << inwards;
  }
}

TEST(BuriedPoints, InAChestThatStandsInTheLightAreThoseHoweverItIsWound) {
  for (const bool inwards : {true, false}) {
    test::PatchBuilder b;
    b.surface("chest").box({1, 1, 0.1}, kX, kY, kZ, {1, 1, 1}, inwards);
    b.surface("room").box({0, 0, 0}, kX * 4, kY * 4, kZ * 3, {1, 1, 1}, true);
    PatchSet patches = b.build();
    std::vector<bool> wanted(2 * patches.triangle_count(), false);
    for (std::size_t t = 0; t < 2 * kBox; ++t) wanted[2 * t + (t < kBox && inwards ? kBack : kFront)] = true;
    make_patches(patches, wanted);
    const RayScene rays(patches);
    const Lights none;
    const std::vector<SensorPoint> points{{{1.5, 1.5, 0.6}, kZ}, {{3, 3, 0.6}, kZ}};
    EXPECT_EQ(buried_points({patches, rays, none}, points), Numbers{0}) << inwards;
  }
}

}  // namespace
}  // namespace clerestory
