// The final gather against its number of rays.

#include <gtest/gtest.h>

#include "solver/form_factors/point_to_polygon.h"
#include "solver/gather/gather_point.h"
#include "tests/convergence/slope.h"
#include "tests/support/gather_quality.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

TEST(GatherPoint, ErrsLessByTheRaysToThreeQuarters) {
  // A room whose six faces shine differently: the sum of B_j times Lambert's contour sum of face j is exact. A stratum
  // is uncertain where the edge of a face crosses it, which sqrt(n) of n strata are: variance n^-3/2.
  test::PatchBuilder b(0.5);
  b.box({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2.5}, {1, 1, 1}, true);
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  const Lights none;
  const Problem problem{patches, rays, none};
  const Vec3 p{1.1, 1.3, rays.lift()}, n{0, 0, 1};  // walls reach below it by the lift, 1e-6 of the light
  Field B(patches.patch_count(), 1);
  double exact = 0;
  for (std::size_t i = 0; i < B.size(); ++i) {
    B.set(i, Spectrum(static_cast<double>(i / 2)));
    if (patches.normal[i].z > 0.5) continue;  // the floor itself
    exact += B[i][0] * point_to_polygon(p, n, patches.corner_positions(PatchId{i}));
  }
  const Illumination light(problem, B);
  constexpr int kSeeds = 128;
  test::Errors errors;
  for (const int count : {64, 256, 1024, 4096}) {
    GatherQuality quality = test::gather_quality({8, count, count});
    quality.area = {.first = 0, .last = 0, .tolerance = 0, .most_rays = 16};  // nothing here is looked at by area
    errors.add(count, test::rms_over_seeds(kSeeds, [&](std::uint64_t seed) {
                 unsigned long long traced = 0;
                 return gather_point(light, p, n, GatherPattern(quality, seed), traced).E[0] / exact - 1;
               }));
  }
  EXPECT_NEAR(test::slope("gather, rays", errors), -0.75, 4 * test::slope_error(errors, kSeeds));
}

}  // namespace
}  // namespace clerestory
