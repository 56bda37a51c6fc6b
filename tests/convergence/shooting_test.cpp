// Progressive shooting against its number of rays.

#include <gtest/gtest.h>

#include "solver/methods/form_factor_matrix.h"
#include "solver/methods/gauss_seidel.h"
#include "solver/methods/progressive.h"
#include "tests/convergence/slope.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

TEST(Shooting, ErrsLessByTheRaysAtLeastByTheRoot) {
  // Against the full matrix of the same patches, whose form factors are closed forms here: nothing blocks. Rays of a
  // shot are stratified, and those of a patch continue one sequence: -1/2 of independent rays at the least, -3/4 for
  // what sees the edges of patches.
  test::PatchBuilder b(0.5);
  b.box({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2.5}, {4, 4, 4}, true);
  PatchSet patches = b.build();
  for (std::size_t i = 0; i < 8; ++i) patches.M.set(i, Spectrum(10));  // a part of the floor
  const RayScene rays(patches);
  const Lights none;
  const Problem problem{patches, rays, none};
  const DirectLight dark = direct_light(Illumination(problem), {});
  const Closure closure = measure_closure(problem, 64, 1);
  const Solution exact = gauss_seidel(patches, form_factor_matrix(patches, rays), Field(patches.patch_count(), 1));
  test::Errors errors;
  for (const double count : {64, 128, 256, 512, 1024})
    errors.add(count, test::rms_over_seeds(8, [&](std::uint64_t seed) {
                 const Solution s =
                     shoot(problem, dark, closure, {.stop_fraction = 1e-4, .rays_per_patch = count, .seed = seed});
                 double squares = 0, mean = 0;
                 for (std::size_t i = 0; i < patches.patch_count(); ++i) {
                   squares += patches.area[i] * std::pow(s.E[i][0] - exact.E[i][0], 2);
                   mean += patches.area[i] * exact.E[i][0];
                 }
                 return std::sqrt(squares * patches.total_area()) / mean;
               }));
  EXPECT_LT(test::slope("shooting, rays", errors), -0.5);
}

}  // namespace
}  // namespace clerestory
