// Constant elements against their size: the classic methods on the full matrix.

#include <numeric>

#include <gtest/gtest.h>

#include "solver/form_factors/point_to_polygon.h"
#include "solver/methods/form_factor_matrix.h"
#include "solver/methods/gauss_seidel.h"
#include "solver/model/random_stream.h"
#include "solver/sampling/unit_square.h"
#include "tests/convergence/slope.h"
#include "tests/support/reference_table.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

/// Rows of one room, in the order floor, ceiling, x0, x1, y0, y1.
std::vector<double> mean_irradiance_of_faces(const std::string& room) {
  std::vector<double> faces;
  for (const test::CsvRow& row : test::reference_table("enclosures.csv"))
    if (row.at("id").starts_with(room + "_")) faces.push_back(std::stod(row.at("value")));
  return faces;
}

/// BOXC01: unit cube, the ceiling glows and is black, all else reflects one half. A surface a face, in the order above.
PatchSet cube(std::size_t n, double rho = 0.5) {
  test::PatchBuilder b(rho);
  b.surface("floor").rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, n);
  b.material(0, 1).surface("ceiling").rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, n, n).material(rho);
  b.surface("x0").rectangle({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, n, n);
  b.surface("x1").rectangle({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, n, n);
  b.surface("y0").rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, n, n);
  b.surface("y1").rectangle({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, n, n);
  return b.build();
}

Solution solved(const PatchSet& patches) {
  return gauss_seidel(patches, form_factor_matrix(patches, RayScene(patches)), Field(patches.patch_count(), 1));
}

TEST(ConstantElements, GiveTheMeansOfFacesNearlyWithTheSquareOfTheirSize) {
  // Form factors are means over elements, so that over a face what constants lose cancels to first order: order 2, but
  // for the edges, next to which light goes like x log x. That leaves h^2 log(1 / h), less than 2 by a little (1.74
  // here). A rule of points, or a mean that is taken wrongly, has 1; the bars are half an order to each side. The
  // reference is known to 2e-5 (enclosures.csv), 7 % of the least error, 0.03 of the slope.
  const std::vector<double> exact = mean_irradiance_of_faces("BOXC01");
  ASSERT_EQ(exact.size(), 6u);
  test::Errors errors;
  for (const std::size_t n : {2, 3, 4, 6, 8}) {
    const PatchSet patches = cube(n);
    const Solution s = solved(patches);
    std::vector<double> off(6);
    for (std::size_t face = 0; face < 6; ++face) off[face] = -exact[face];
    for (std::size_t i = 0; i < patches.patch_count(); ++i) off[i / (2 * n * n)] += patches.area[i] * s.E[i][0];
    errors.add(1 / static_cast<double>(n), std::sqrt(std::inner_product(off.begin(), off.end(), off.begin(), 0.0) / 6));
  }
  const double slope = test::slope("element size, means of faces", errors);
  EXPECT_GT(slope, 1.5);
  EXPECT_LT(slope, 2.5);
}

TEST(ConstantElements, ShowLightWithTheirSize) {
  // Light that only the ceiling gives: Lambert's contour sum at points of the floor. A constant misses a smooth light
  // by its gradient times the size: order 1.
  const std::array<Vec3, 4> ceiling{Vec3{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
  constexpr std::uint64_t kPoints = 2048;
  test::Errors errors;
  for (const std::size_t n : {3, 4, 6, 8, 12}) {
    const PatchSet patches = cube(n, 0);
    const Solution s = solved(patches);
    const std::size_t on_floor = 2 * n * n;
    errors.add(1 / static_cast<double>(n), test::rms_over_seeds(kPoints, [&](std::uint64_t point) {
                 const auto u = sobol4(static_cast<std::uint32_t>(point), 1);
                 const auto i = static_cast<std::size_t>(u[2] * static_cast<double>(on_floor));
                 const Vec3 x = point_on_triangle(patches.corner_positions(PatchId{i}), u[0], u[1]);
                 return s.E[i][0] - point_to_polygon(x, {0, 0, 1}, ceiling);
               }));
  }
  EXPECT_NEAR(test::slope("element size, light at points", errors), 1, 4 * test::slope_error(errors, kPoints));
}

}  // namespace
}  // namespace clerestory
