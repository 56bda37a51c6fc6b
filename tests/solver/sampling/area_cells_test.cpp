#include "solver/sampling/area_cells.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/gather_quality.h"

namespace clerestory {
namespace {

/// Lower corner and side of a cell, from its Morton number.
struct Place {
  double u = 0, v = 0, side;
};
Place place(const AreaCell& cell) {
  Place p{0, 0, 1.0 / (4 << cell.grid)};
  for (int bit = 0; bit < 16; ++bit) {
    const double step = p.side * static_cast<double>(1 << (bit / 2));
    if (cell.number >> bit & 1) (bit % 2 == 1 ? p.u : p.v) += step;
  }
  return p;
}

TEST(AreaCells, EveryCellOfEveryGridHoldsItsTwoPoints) {
  const AreaCells cells(AreaCells::kGrids - 1, 7);
  for (int grid = 0; grid < AreaCells::kGrids; ++grid)
    for (std::uint32_t c = 0; c < AreaCells::count(grid); ++c) {
      const Place at = place({static_cast<std::uint16_t>(grid), static_cast<std::uint16_t>(c)});
      for (const auto* points : {&cells.points(grid), &cells.pilots(grid)}) {
        const auto [u, v] = (*points)[c];
        ASSERT_TRUE(u >= at.u && u <= at.u + at.side && v >= at.v && v <= at.v + at.side)
            << "grid " << grid << " cell " << c << ": " << u << ", " << v;
      }
    }
}

/// Mean of `value` by the plan made for it, and the rays of pilots and cells together.
struct Estimate {
  double value = 0;
  std::size_t rays = 0;
  AreaPlan plan;
};
template <class Value>
Estimate estimate(const AreaBudget& budget, std::uint64_t seed, const Value& value, double others = 0) {
  const AreaCells cells(budget.last, seed);
  Estimate e;
  e.plan = plan_area(cells, budget, others, [&](auto points, auto values) {
    e.rays += points.size();
    for (std::size_t k = 0; k < points.size(); ++k) values[k] = Spectrum(value(points[k][0], points[k][1]));
  });
  for (std::size_t k = 0; k < e.plan.size(); ++k) {
    const AreaCell cell = e.plan[k];
    const auto [u, v] = cells.points(cell.grid)[cell.number];
    e.value += cell.share() * value(u, v);
  }
  e.rays += e.plan.size();
  return e;
}

TEST(PlanArea, CellsCoverTheSquareOnce) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Estimate e =
        estimate({2, 6, 0, 8192}, seed, [](double u, double v) { return u + 0.3 * v < 0.21 ? 1.0 : 0.0; });
    double share = 0;
    for (const AreaCell& cell : e.plan.cells) share += cell.share();
    EXPECT_NEAR(share, 1, 1e-12);
    for (const AreaCell& cell : e.plan.cells) {
      const Place at = place(cell);
      int holders = 0;
      for (const AreaCell& other : e.plan.cells) {
        const Place o = place(other);
        const double u = at.u + at.side / 2, v = at.v + at.side / 2;
        holders += u > o.u && u < o.u + o.side && v > o.v && v < o.v + o.side;
      }
      ASSERT_EQ(holders, 1);
    }
  }
}

TEST(PlanArea, AnEvenViewCostsFewRaysAndItsMeanIsExact) {
  const Estimate e = estimate(test::kAreaBudget, 1, [](double, double) { return 3.0; });
  EXPECT_EQ(e.rays, 128u);
  EXPECT_NEAR(e.plan.mean[0], 3, 1e-12);
}

TEST(PlanArea, IsUnbiasedAndAccurateAlongAStraightEdge) {
  // A strip 6 % wide along a slanted edge at the border of the square.
  const auto strip = [](double u, double v) { return v < 0.04 + 0.04 * u ? 1.0 : 0.0; };
  double mean = 0, square = 0;
  constexpr int kSeeds = 40;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const double off = estimate(test::kAreaBudget, static_cast<std::uint64_t>(seed), strip).value / 0.06 - 1;
    mean += off / kSeeds, square += off * off / kSeeds;
  }
  EXPECT_LT(std::sqrt(square), 0.01);  // 8,192 rays all over the square would leave 4 % were they random
  EXPECT_LT(std::abs(mean), 4 * std::sqrt(square / kSeeds));
}

TEST(PlanArea, WhatIsLittleBesideOtherLightCostsFewRays) {
  const auto half = [](double u, double v) { return v < 0.3 + 0.4 * u ? 1.0 : 0.0; };
  constexpr AreaBudget kBudget{.first = 1, .last = 5, .tolerance = 0.003, .most_rays = 8192};
  constexpr double kOthers = 200;
  double square = 0;
  constexpr int kSeeds = 40;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const auto key = static_cast<std::uint64_t>(seed);
    const Estimate little = estimate(kBudget, key, half, kOthers);
    EXPECT_EQ(little.rays, 32u);
    EXPECT_GT(estimate(kBudget, key, half).rays, 10 * little.rays) << "where there is no other light";
    square += (little.value - 0.5) * (little.value - 0.5) / kSeeds;
  }
  EXPECT_LT(std::sqrt(square), kBudget.tolerance * kOthers);
  EXPECT_GT(std::sqrt(square), 0.001) << "nothing was left out";
}

TEST(PlanArea, RaysStayWithinTheirBudget) {
  for (const std::size_t most : {512u, 2048u, 8192u})
    EXPECT_LE(
        estimate({2, 6, 0, most}, 3, [](double u, double v) { return std::fmod(17 * u + 11 * v, 1) < 0.5 ? 1.0 : 0.0; })
            .rays,
        2 * most);
}

}  // namespace
}  // namespace clerestory
