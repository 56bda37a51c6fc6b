// The hierarchical method against its rays and its tolerance.

#include "solver/methods/hierarchical.h"

#include <gtest/gtest.h>

#include "solver/form_factors/point_to_polygon.h"
#include "solver/model/random_stream.h"
#include "solver/sampling/unit_square.h"
#include "tests/convergence/slope.h"
#include "tests/support/unjoined_lightmap.h"

namespace clerestory {
namespace {

HierarchicalSolution solve(const PatchSet& patches, const HierarchyOptions& options) {
  const RayScene rays(patches);
  const Lights none;
  const Problem problem{patches, rays, none};
  const VertexLightmap map = test::unjoined_lightmap(patches);
  ElementMesh mesh(patches, map);
  return hierarchical(problem, mesh, options);
}

TEST(Hierarchical, ErrsLessByTheRaysAtLeastByTheRoot) {
  // Rays of a bundle are stratified: -3/4 where they see edges (gather_test.cpp), -1/2 of independent rays at the
  // least, for what goes round several times. More than 1,500 elements, as fewer of them get more rays than they were
  // given. The reference has eight times the most rays: at -1/2 its own errors add 6 % to the last, 0.03 to the slope.
  test::PatchBuilder b(0.6);
  b.box({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 3}, {12, 12, 12}, true);
  b.material(0.3, 5).box({1, 1, 1}, {0.8, 0, 0}, {0, 0.8, 0}, {0, 0, 0.8}, {2, 2, 2}, false);
  const PatchSet patches = b.build();
  const auto E = [&](int rays, std::uint64_t seed) {
    return solve(patches, {.bundle_rays = rays, .bright_rays = rays, .tolerance = 1e9, .seed = seed}).solution.E;
  };
  const Field reference = E(2048, 99);
  double mean = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) mean += patches.area[i] * reference[i][0];
  test::Errors errors;
  for (const int rays : {16, 32, 64, 128, 256})
    errors.add(rays, test::rms_over_seeds(2, [&](std::uint64_t seed) {
                 const Field found = E(rays, seed);
                 double squares = 0;
                 for (std::size_t i = 0; i < patches.patch_count(); ++i)
                   squares += patches.area[i] * std::pow(found[i][0] - reference[i][0], 2);
                 return std::sqrt(squares * patches.total_area()) / mean;
               }));
  EXPECT_LT(test::slope("hierarchical, rays", errors), -0.5);
}

TEST(Hierarchical, ShowsLightWithTheSizeOfItsElements) {
  // A floor under a lamp, and nothing to send light back: Lambert's contour sum is exact.
  test::PatchBuilder b(0.9);
  b.rectangle({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, 2, 2);
  b.material(0, 1).rectangle({1, 1, 1}, {0, 1, 0}, {1, 0, 0}, 2, 2);
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  const std::array<Vec3, 4> lamp{Vec3{1, 1, 1}, {1, 2, 1}, {2, 2, 1}, {2, 1, 1}};
  test::Errors by_tolerance, by_elements;
  for (const double tolerance : {0.5, 0.25, 0.125, 0.0625, 0.03125}) {
    const HierarchicalSolution h = solve(patches, {.bundle_rays = 16, .tolerance = tolerance});
    const double error = test::rms_over_seeds(4096, [&](std::uint64_t point) {
      const auto u = sobol4(static_cast<std::uint32_t>(point), 1);
      const Vec3 x{3 * u[0], 3 * u[1], 0};
      const PatchId element = rays.first_hit(h.elements, {x + Vec3{0, 0, 0.1}, {0, 0, -1}}).patch;
      return h.solution.E[element][0] / point_to_polygon(x, {0, 0, 1}, lamp) - 1;
    });
    by_tolerance.add(tolerance, error), by_elements.add(static_cast<double>(h.elements.patch_count()), error);
  }
  // Constants err by the size, and N elements of a surface have the size N^-1/2. Halving makes an element up to sqrt(2)
  // smaller than it need be: log errors are even over log sqrt(2), 0.1 about its middle, which over these N is 0.024 of
  // the slope, and over these tolerances 0.046. Bars are four times that.
  EXPECT_NEAR(test::slope("hierarchical, elements", by_elements), -0.5, 0.1);
  // An element is halved while light varies by more than the tolerance, error ~ tolerance, and while that is more than
  // it over the element's share of the area, error h^2 ~ error^3 ~ tolerance.
  const double slope = test::slope("hierarchical, tolerance", by_tolerance);
  EXPECT_GT(slope, 1.0 / 3 - 0.18);
  EXPECT_LT(slope, 1 + 0.18);
}

}  // namespace
}  // namespace clerestory
