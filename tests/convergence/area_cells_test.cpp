// The mean of a picture over the cells of an area, one point a cell.

#include "solver/sampling/area_cells.h"

#include <gtest/gtest.h>

#include "tests/convergence/slope.h"

namespace clerestory {
namespace {

using test::Errors;

constexpr int kSeeds = 64;

/// Root mean square error of the mean over each grid, against the exact one.
template <class Value>
Errors errors_by_grid(double exact, const Value& value) {
  Errors errors;
  for (int grid = 0; grid < 5; ++grid)
    errors.add(AreaCells::count(grid), test::rms_over_seeds(kSeeds, [&](std::uint64_t seed) {
                 const AreaCells cells(grid, seed);
                 double sum = 0;
                 for (const auto& [u, v] : cells.points(grid)) sum += value(u, v);
                 return sum / AreaCells::count(grid) - exact;
               }));
  return errors;
}

TEST(AreaCells, OfASmoothViewErrLessByThePointsToThreeHalves) {
  // Scrambled nets: variance n^-3 for smooth functions (Owen 1997), so -3/2; independent points have -1/2.
  const Errors e =
      errors_by_grid(std::pow(std::exp(1.0) - 1, 2), [](double u, double v) { return std::exp(u) * std::exp(v); });
  EXPECT_NEAR(test::slope("area cells, smooth", e), -1.5, 4 * test::slope_error(e, kSeeds));
}

TEST(AreaCells, AcrossAnEdgeErrLessByThePointsToThreeQuarters) {
  // A straight edge crosses sqrt(n) of n cells, each of them in or out by chance: variance n^-3/2.
  const Errors e = errors_by_grid(0.3 + 0.4 / 2, [](double u, double v) { return v < 0.3 + 0.4 * u ? 1.0 : 0.0; });
  EXPECT_NEAR(test::slope("area cells, edge", e), -0.75, 4 * test::slope_error(e, kSeeds));
}

}  // namespace
}  // namespace clerestory
