#include "solver/evaluate/measured_error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/evaluate/points_by_room.h"
#include "solver/evaluate/reference_paths.h"
#include "solver/model/random_stream.h"
#include "solver/paths/path_tracer.h"
#include "tests/support/lit_patches.h"
#include "tests/support/luminaires.h"
#include "tests/support/room_with_blocks.h"
#include "tests/support/unjoined_lightmap.h"

namespace clerestory {
namespace {

double normal(RandomStream& random) {
  const double r = std::sqrt(-2 * std::log(1 - random.uniform()));
  return r * std::cos(2 * std::numbers::pi * random.uniform());
}

/// What summarise() makes of many measurements of fields whose error is known.
struct Outcome {
  double rms_squared = 0, p95 = 0;  ///< means
  double covered = 0;               ///< share of measurements whose confidence holds the true rms
};

/// References of mean 1 are seen through noise of standard deviation `noise`, itself estimated from eight replicates.
Outcome measure(std::size_t points, double noise, double true_rms, const std::function<double(RandomStream&)>& error) {
  Outcome outcome;
  constexpr int kRepeats = 300;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    RandomStream random(1, static_cast<std::uint64_t>(repeat));
    std::vector<Comparison> comparisons;
    for (std::size_t i = 0; i < points; ++i) {
      PathSum replicates;
      for (int k = 0; k < 8; ++k) replicates.add(Spectrum(1 + noise * std::sqrt(8.0) * normal(random)));
      comparisons.push_back(
          {.x = 1 + error(random), .r = replicates.mean()[0], .std_error = replicates.std_error()[0]});
    }
    const ErrorFigures e = summarise(comparisons);
    outcome.rms_squared += e.rms_relative * e.rms_relative / kRepeats;
    outcome.p95 += e.p95_relative / kRepeats;
    outcome.covered += (std::abs(e.rms_relative - true_rms) <= e.confidence) / static_cast<double>(kRepeats);
  }
  return outcome;
}

TEST(MeasuredError, SeesThroughNoiseAsLargeAsTheError) {
  for (const double noise : {0.002, 0.01, 0.02}) {
    const Outcome o = measure(256, noise, 0.02, [](RandomStream& r) { return 0.02 * normal(r); });
    EXPECT_NEAR(std::sqrt(o.rms_squared), 0.02, 0.02 * 0.02) << noise;  // 300 measurements, each known to 13 %
    EXPECT_NEAR(o.p95, 1.96 * 0.02, 0.1 * 1.96 * 0.02) << noise;
    EXPECT_GT(o.covered, 0.9);
  }
}

TEST(MeasuredError, FindsTheTailOfAnErrorThatIsSmallInMostPlaces) {
  // One point in ten is off by 6 %: the 95th percentile of |error| is where half of those lie above: 0.674 * 6 %.
  const double true_rms = std::sqrt(0.9 * 0.005 * 0.005 + 0.1 * 0.06 * 0.06);
  for (const double noise : {0.002, 0.01, 0.02}) {
    const Outcome o = measure(256, noise, true_rms, [](RandomStream& r) {
      const double size = r.uniform() < 0.1 ? 0.06 : 0.005;
      return size * normal(r);
    });
    EXPECT_NEAR(std::sqrt(o.rms_squared), true_rms, 0.03 * true_rms) << noise;
    EXPECT_NEAR(o.p95, 0.0405, 0.12 * 0.0405) << noise;
    EXPECT_GT(o.covered, 0.85);  // few points carry it all
  }
}

TEST(MeasuredError, OfAFewLargeErrorsInNoiseIsNotToldTooSmall) {
  const double true_rms = std::sqrt(0.98 * 0.005 * 0.005 + 0.02 * 0.2 * 0.2);
  const Outcome o = measure(256, 0.01, true_rms, [](RandomStream& r) {
    const double size = r.uniform() < 0.02 ? 0.2 : 0.005;
    return size * normal(r);
  });
  EXPECT_NEAR(std::sqrt(o.rms_squared), true_rms, 0.05 * true_rms);  // five points carry it
  EXPECT_GT(o.p95, 0.0103);
  EXPECT_LT(o.p95, 0.0103 + 1.96 * 0.01);
}

TEST(MeasuredError, TakesPureNoiseForAlmostNothing) {
  // The mean square of 256 differences is known to 9 %, and its bound is twice that: 0.42 of the noise.
  const Outcome o = measure(256, 0.02, 0, [](RandomStream&) { return 0.0; });
  EXPECT_NEAR(std::sqrt(o.rms_squared), 0.42 * 0.02, 0.1 * 0.02);
  EXPECT_LT(o.p95, 0.6 * 1.96 * 0.02);
  EXPECT_GT(o.covered, 0.9);
}

TEST(MeasuredError, TellsBiasAndTheFarTail) {
  // Without noise: 970 points are 1 % too bright, 20 too dark by 30 %, 10 by 60 %.
  std::vector<Comparison> comparisons;
  for (int i = 0; i < 1000; ++i) comparisons.push_back({.x = i < 970 ? 2.02 : i < 990 ? 1.4 : 0.8, .r = 2});
  const ErrorFigures e = summarise(comparisons);
  EXPECT_NEAR(e.bias_relative, 0.97 * 0.01 - 0.02 * 0.3 - 0.01 * 0.6, 1e-12);
  EXPECT_NEAR(e.p95_relative, 0.01, 1e-12);
  EXPECT_NEAR(e.p99_relative, 0.3, 1e-12);
}

TEST(MeasuredError, CountsComparisonsByTheAreaTheyStandFor) {
  // Nine tenths of the area are off by 1 %, one tenth by 10 %, and both were looked at equally often.
  std::vector<Comparison> comparisons;
  for (int k = 0; k < 100; ++k)
    comparisons.push_back({.x = 1.01, .r = 1, .weight = 0.9}), comparisons.push_back({.x = 1.1, .r = 1, .weight = 0.1});
  const ErrorFigures e = summarise(comparisons);
  EXPECT_NEAR(e.rms_relative, std::sqrt(0.9 * 0.01 * 0.01 + 0.1 * 0.1 * 0.1), 1e-12);
  EXPECT_NEAR(e.p95_relative, 0.1, 1e-12);
}

TEST(MeasuredError, LooksIntoASmallDarkSpaceBesideALargeBrightOne) {
  // Two closed rooms; the small one has 1 / 2501 of the area, 0.4 of 1024 points. The large one glows, E = M / (1 -
  // rho) = 100 everywhere; the small one is dark, and the result shows 100 there as well: rms 100 sqrt(1 / 2501) of
  // 100.
  test::PatchBuilder b;
  const auto room = [&](double x, double size) {
    b.box({x, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}, {1, 1, 1}, true);
  };
  b.material(0.5, 50);
  room(0, 10);
  b.material(0.5);
  room(20, 0.2);
  PatchSet patches = b.build();
  for (std::size_t i = 0; i < patches.patch_count(); ++i)
    patches.room.push_back(patches.corner_positions(PatchId{i})[0].x > 15 ? 1 : 0);
  patches.rooms = {"large", "small"};
  const RayScene rays(patches);
  const Lights lights;
  VertexLightmap map = test::unjoined_lightmap(patches);
  map.E = Field(map.position.size(), 1);
  std::ranges::fill(map.E.value, 100);
  Solution solution;  // the error is in it as well, and gathers look up what it says
  solution.E = Field(patches.patch_count(), 1);
  std::ranges::fill(solution.E.value, 100);
  solution.B = solution.E;
  const MeasuredError e = measure_error({patches, rays, lights}, map, solution,
                                        {1024, 64, 1e6, {{8, 128, 128}, {0, 1, 0.02, 128}, 32, 1}}, 1);
  EXPECT_NEAR(e.rms_relative, 0.02, 0.01);  // ten points see it
  ASSERT_EQ(e.parts.size(), 2u);
  EXPECT_EQ(e.parts[1].name, "small");
  EXPECT_EQ(e.parts[1].figures.samples, 0u) << "no path finds light there";
  EXPECT_LT(e.parts[0].figures.upper(), 0.02);
}

TEST(PointsByRoom, AThirdGoesWhereLightChangesAndAreasStayRight) {
  test::PatchBuilder b(0.5);
  b.rectangle({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, 20, 20);
  const PatchSet patches = b.build();
  std::vector<double> change(patches.patch_count());
  change[5] = 3;  // one in 800
  constexpr std::size_t kPoints = 3000;
  double there = 0, left = 0, all = 0;
  for (const PointInRoom& at : PointsByRoom(patches, change).points(kPoints, 1)) {
    there += at.patch == 5;
    all += at.weight;
    if (patches.corner_positions(PatchId{at.patch})[0].x + patches.origin.x < 4.75) left += at.weight;
  }
  EXPECT_NEAR(there / kPoints, 1.0 / 3, 0.01);
  double area = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i)
    if (patches.corner_positions(PatchId{i})[0].x + patches.origin.x < 4.75) area += patches.area[i];
  EXPECT_NEAR(left / all, area / patches.total_area(), 0.02);
}

TEST(MeasuredError, TheLargestIsThatOfTheWorstPartThatCounts) {
  MeasuredError e{{.rms_relative = 0.01, .samples = 300, .confidence = 0.002}};
  e.parts = {{.name = "hall", .area = 90, .figures = {.rms_relative = 0.01, .samples = 200, .confidence = 0.002}},
             {.name = "room", .area = 9.5, .figures = {.rms_relative = 0.05, .samples = 90, .confidence = 0.02}},
             {.name = "frame", .area = 0.5, .figures = {.rms_relative = 0.9, .samples = 10, .confidence = 0.1}}};
  EXPECT_EQ(e.largest().measured, 0.05);
  EXPECT_DOUBLE_EQ(e.largest().lower, 0.05 - 0.02);
  EXPECT_DOUBLE_EQ(e.largest().upper, 0.05 + 0.02);
  e.parts[1].figures = {};  // no path found light there
  e.parts[1].mean_illuminance = 3;
  EXPECT_EQ(e.largest().lower, 1);
}

TEST(ErrorFigures, OfOnePointAreNeverNothing) {
  // A value that is right by chance, by gathers and by paths.
  const std::vector<Comparison> gathered{{.x = 10, .r = 10, .std_error = 0.3, .gather = 10, .other_gather = 10.1}};
  EXPECT_GT(summarise(gathered).upper(), 0.3 / 10);
  const std::vector<Comparison> traced{{.x = 10, .r = 10, .std_error = 0.3}};
  EXPECT_GT(summarise(traced).upper(), 0.3 / 10);
}

/// Fifty points of a result that is right and varies by `varies` within elements; paths say `off` less, each +-
/// scatter. has_elements: those say that it is right.
ErrorFigures told_of_right_one(double off, double scatter, double varies, bool has_elements, bool knows_variation) {
  std::vector<Comparison> at;
  for (int k = 0; k < 50; ++k) {
    const double within = k % 2 ? varies : -varies, noise = k % 4 < 2 ? scatter : -scatter;
    const double gather = 1 + within + (k % 3 - 1) * 0.002;
    at.push_back({.x = 1 + within,
                  .r = 1 + within - off + noise,
                  .std_error = scatter,
                  .gather = gather,
                  .other_gather = 2 * (1 + within) - gather,
                  .element = has_elements ? 1.0 : -1.0,
                  .off_mean = knows_variation ? within : 0,
                  .albedo = 0.5});
  }
  return summarise(at);
}

TEST(ErrorFigures, PathsAreTakenForChanceWhereTheResidualContradictsThem) {
  // Ten per cent, which is three standard errors.
  const double off = 0.1, three = off * std::sqrt(50) / 3, six = off * std::sqrt(50) / 6;
  EXPECT_LT(told_of_right_one(off, three, 0.3, true, true).upper(), 0.02);
  EXPECT_NEAR(told_of_right_one(off, three, 0.3, false, false).rms_relative, off, 0.02);
  // What varies within elements would hide what they know.
  EXPECT_GT(told_of_right_one(off, three, 0.3, true, false).upper(), 0.05);
  // And no chance is that.
  EXPECT_NEAR(told_of_right_one(off, six, 0.3, true, true).rms_relative, off, 0.02);
}

TEST(ReferencePaths, AreFromBothEndsWhereThoseFromPointsFindTheLightByChance) {
  // A lamp without size in the middle of a room, and one near the ceiling with a plate 2 cm below it, so that all light
  // comes off the ceiling. In a white room all paths find it, and are long.
  struct Room {
    bool has_plate;
    double rho;
  };
  for (const auto [has_plate, rho] : {Room{false, 0.6}, Room{true, 0.6}, Room{true, 0.9995}}) {
    test::PatchBuilder b(rho);
    b.box({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2.5}, {4, 3, 3}, true);
    if (has_plate)
      b.rectangle({1.8, 1.3, 2.46}, {0.4, 0, 0}, {0, 0.4, 0}).rectangle({1.8, 1.3, 2.46}, {0, 0.4, 0}, {0.4, 0, 0});
    Lights lights;
    lights.luminaires = {test::point_lamp({2, 1.5, has_plate ? 2.48 : 1.5}, 100)};
    const test::LitPatches room(b.build(), std::move(lights));
    const Illumination light(room.problem);
    const ReferencePaths paths(light, 64,
                               [](std::size_t i) {
                                 const auto u = sobol4(static_cast<std::uint32_t>(i), 5);
                                 return ReceivingPoint{{0.1 + 3.8 * u[0], 0.1 + 2.8 * u[1], 1e-4}, {0, 0, 1}};
                               },
                               1, {});
    EXPECT_EQ(paths.are_from_both_ends(), has_plate && rho < 0.9) << rho;
  }
}

}  // namespace
}  // namespace clerestory
