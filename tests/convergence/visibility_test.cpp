// What blocks light between two patches, against the number of rays.

#include <gtest/gtest.h>

#include "solver/form_factors/sampled.h"
#include "solver/model/random_stream.h"
#include "tests/convergence/slope.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

TEST(SampledVisibility, ErrsLessByTheRaysToFiveEighths) {
  // Two facing triangles with a screen half their size between. Pairs of points have four dimensions, and the edge of
  // what is blocked crosses n^(3/4) of n strata: variance n^-5/4.
  test::PatchBuilder b;
  b.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0});
  b.rectangle({0.25, 0.25, 0.5}, {0.5, 0, 0}, {0, 0.5, 0});
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  const SampledTriangle from{patches.corner_positions(PatchId{0}), patches.normal[0]};
  const SampledTriangle to{patches.corner_positions(PatchId{2}), patches.normal[2]};
  const double exact = sample_visibility(from, to, rays, 99, 1 << 20).value;
  constexpr int kSeeds = 32;
  test::Errors errors;
  for (const int samples : {1 << 8, 1 << 10, 1 << 12, 1 << 14})
    errors.add(samples, test::rms_over_seeds(kSeeds, [&](std::uint64_t seed) {
                 return sample_visibility(from, to, rays, stream_key(1, seed), samples).value - exact;
               }));
  EXPECT_NEAR(test::slope("visibility, rays", errors), -0.625, 4 * test::slope_error(errors, kSeeds));
}

}  // namespace
}  // namespace clerestory
