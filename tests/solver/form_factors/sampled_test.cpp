#include "solver/form_factors/sampled.h"

#include <gtest/gtest.h>

#include "solver/form_factors/polygon_to_polygon.h"
#include "solver/geometry/polygon.h"
#include "solver/model/random_stream.h"
#include "tests/solver/form_factors/reference_rows.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using test::PatchBuilder;
using test::Polygon;

struct Estimate {
  double F = 0, std_error = 0;
};

/// Form factor between two polygons past black occluders, triangle pair by triangle pair.
Estimate sampled_form_factor(const Polygon& from, const Polygon& to, const std::vector<Polygon>& occluders, int samples,
                             std::uint64_t seed) {
  PatchBuilder builder;
  for (const std::vector<Polygon>& polygons : {std::vector{from, to}, occluders})
    for (const Polygon& polygon : polygons)
      for (const auto& t : triangulate(polygon)) builder.triangle(t[0], t[1], t[2]);
  const PatchSet patches = builder.build();
  const RayScene rays(patches);
  const double area = length(vector_area(from));
  Estimate sum;
  double variance = 0;
  std::uint64_t pair = 0;
  for (const auto& p : triangulate(from))
    for (const auto& q : triangulate(to)) {
      const double F = exchange_area(p, q) / area;
      const SampledVisibility V = sample_visibility({p, normalized(vector_area(p))}, {q, normalized(vector_area(q))},
                                                    rays, stream_key(seed, pair++), samples);
      sum.F += F * V.value;
      variance += F * F * V.std_error * V.std_error;
    }
  sum.std_error = std::sqrt(variance);
  return sum;
}

const Polygon kFloor{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const Polygon kCeiling{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
Polygon screen(double x0, double x1, double y0, double y1) {
  return {{x0, y0, 0.5}, {x1, y0, 0.5}, {x1, y1, 0.5}, {x0, y1, 0.5}};
}

TEST(SampledVisibility, AnOccluderHalfwayMatchesTheQuadratureWithinItsStandardError) {
  // Rows OCC01 (centred, half size) and OCC08 (a half-screen: exactly half of the open value) of the reference table.
  const Estimate half_size = sampled_form_factor(kFloor, kCeiling, {screen(0.25, 0.75, 0.25, 0.75)}, 1 << 14, 1);
  EXPECT_NEAR(half_size.F, 0.0995062945989848, 4 * half_size.std_error);
  const Estimate half_screen = sampled_form_factor(kFloor, kCeiling, {screen(-1, 0.5, -1, 2)}, 1 << 14, 2);
  EXPECT_NEAR(half_screen.F, 0.199824895698387 / 2, 4 * half_screen.std_error);
  EXPECT_LT(half_size.std_error, 0.002 * half_size.F);
}

TEST(SampledVisibility, AScreenThatCoversAllLeavesNothing) {
  EXPECT_EQ(sampled_form_factor(kFloor, kCeiling, {screen(0, 1, 0, 1)}, 1 << 12, 3).F, 0);
}

TEST(SampledVisibility, IsUnbiasedAndItsStandardErrorIsHonest) {
  // 64 independent runs of each estimator: their mean is right within the standard error of the mean, and their spread
  // is what each run says of itself (within a factor of 1.5; the quick one may only be too careful).
  const std::array<Vec3, 3> p{kFloor[0], kFloor[1], kFloor[2]}, q{kCeiling[0], kCeiling[1], kCeiling[2]};
  PatchBuilder builder;
  for (const Polygon& polygon : {kFloor, kCeiling, screen(0.25, 0.75, 0.25, 0.75)})
    for (const auto& t : triangulate(polygon)) builder.triangle(t[0], t[1], t[2]);
  const PatchSet patches = builder.build();
  const RayScene rays(patches);
  const SampledTriangle from{p, {0, 0, 1}}, to{q, {0, 0, -1}};
  const double exact = sample_visibility(from, to, rays, 99, 1 << 20).value;  // error about 1e-5
  const auto check = [&](const char* name, double least_ratio, auto estimate) {
    constexpr int kRuns = 64;
    double mean = 0, square = 0, claimed = 0;
    for (std::uint64_t run = 0; run < kRuns; ++run) {
      const SampledVisibility V = estimate(stream_key(17, run));
      mean += V.value / kRuns;
      square += (V.value - exact) * (V.value - exact) / kRuns;
      claimed += V.std_error * V.std_error / kRuns;
    }
    EXPECT_NEAR(mean, exact, 4 * std::sqrt(square / kRuns)) << name;
    EXPECT_LT(std::sqrt(square), 1.5 * std::sqrt(claimed)) << name;
    EXPECT_GT(std::sqrt(square), least_ratio * std::sqrt(claimed)) << name;
  };
  check("quick", 0.2, [&](std::uint64_t key) { return sample_visibility_quick(from, to, rays, key); });
  check("by sets", 1 / 1.5, [&](std::uint64_t key) { return sample_visibility(from, to, rays, key, 1024); });
}

TEST(SampledVisibility, EveryOccludedReferenceRowWithinItsOwnStandardError) {
  int rows = 0;
  for (const auto& row : test::reference_rows()) {
    if (row.occluders.empty()) continue;
    const Estimate F = sampled_form_factor(row.polygon1, row.polygon2, row.occluders, 1 << 16, 5);
    EXPECT_NEAR(F.F, row.value, 4 * F.std_error) << row.id;
    ++rows;
  }
  EXPECT_GE(rows, 4);
}

}  // namespace
}  // namespace clerestory
