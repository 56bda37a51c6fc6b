// Paths against their number.

#include <gtest/gtest.h>

#include "solver/methods/path.h"
#include "tests/convergence/slope.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

TEST(Paths, ErrLessByTheRootOfTheirNumber) {
  // The mean irradiance of a closed room of one reflectance is flux / ((1 - rho) area). Only the start of a path is
  // stratified; its bounces are plain random numbers: -1/2.
  constexpr double kRho = 0.7;
  test::PatchBuilder b(kRho);
  b.box({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2.5}, {1, 1, 1}, true);
  b.material(kRho, 100)
      .rectangle({1, 1, 1}, {1, 0, 0}, {0, 1, 0})
      .material(kRho)
      .rectangle({1, 1, 0.99}, {0, 1, 0}, {1, 0, 0});
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  const Lights none;
  const Problem problem{patches, rays, none};
  const Illumination light(problem);
  const DirectLight dark{Field(patches.patch_count(), 1), {}, {}, {}, 0};
  const Closure closure = measure_closure(problem, 16, 1);
  const double exact = 100 / ((1 - kRho) * patches.total_area());
  constexpr int kSeeds = 64;
  test::Errors errors;
  for (const int paths : {16, 32, 64, 128, 256})
    errors.add(paths, test::rms_over_seeds(kSeeds, [&](std::uint64_t seed) {
                 const Solution s =
                     path_trace(light.problem, light, "path", dark, closure, {.paths = paths, .seed = seed});
                 double mean = 0;
                 for (std::size_t i = 0; i < patches.patch_count(); ++i)
                   mean += patches.area[i] * s.E[i][0] / patches.total_area();
                 return mean / exact - 1;
               }));
  EXPECT_NEAR(test::slope("paths", errors), -0.5, 4 * test::slope_error(errors, kSeeds));
}

}  // namespace
}  // namespace clerestory
