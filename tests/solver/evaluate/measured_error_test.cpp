#include "solver/evaluate/measured_error.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/model/random_stream.h"
#include "solver/paths/path_tracer.h"

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
      comparisons.push_back({1 + error(random), replicates.mean()[0], replicates.std_error()[0]});
    }
    const MeasuredError e = summarise(comparisons);
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
  const Outcome o = measure(256, 0.02, 0, [](RandomStream&) { return 0.0; });
  EXPECT_LT(std::sqrt(o.rms_squared), 0.006);  // the mean square of 256 differences is known to 9 %
  EXPECT_LT(o.p95, 0.6 * 1.96 * 0.02);
}

}  // namespace
}  // namespace clerestory
