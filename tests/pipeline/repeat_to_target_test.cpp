// Rounds of a target error, by rounds that are made up.

#include "pipeline/repeat_to_target.h"

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "solver/methods/form_factor_matrix.h"

namespace clerestory {
namespace {

struct Steps : Observer {
  std::vector<std::string> lines;
  void step(const std::string& line) override { lines.push_back(line); }
};

/// 1,000 patches, so far off, of whose light a share is missing.
Solved with_error(double error, double missing) {
  Solved solved;
  solved.patches.triangle.resize(1000);
  solved.solution.energy = {.emitted = 100, .absorbed = 100 * (1 - missing), .escaped = 0};
  solved.error = MeasuredError{{.rms_relative = error, .samples = 100, .confidence = 0.1 * error}};
  return solved;
}

Settings asking_for(double target, Method method = Method::hierarchical) {
  Settings settings;
  settings.target_error = target;
  settings.solve.method = method;
  return settings;
}

TEST(RepeatToTarget, GoesOnWhileLightIsMissingThoughTheErrorIsSmall) {
  std::vector<Accuracy> rounds;
  Steps steps;
  const Solved best = repeat_to_target(asking_for(0.05), steps, [&](Settings& s, const Monitor&, StageSeconds&) {
    rounds.push_back(s.solve.accuracy);
    return std::optional(with_error(0.01, rounds.size() < 3 ? 0.02 : 0.001));
  });
  EXPECT_EQ(rounds, (std::vector{Accuracy::draft, Accuracy::standard, Accuracy::fine}));
  EXPECT_TRUE(meets_target(best));
  ASSERT_EQ(steps.lines.size(), 2u);
  EXPECT_TRUE(steps.lines[0].starts_with("2.00 % of the light is missing or too much with draft")) << steps.lines[0];
}

TEST(RepeatToTarget, KeepsTheBetterResultOfTwoThatBothMiss) {
  int rounds = 0;
  Steps steps;
  const Solved best = repeat_to_target(asking_for(0.01), steps, [&](Settings&, const Monitor&, StageSeconds&) {
    return std::optional(with_error(++rounds == 1 ? 0.05 : 0.06, 0));
  });
  EXPECT_EQ(rounds, 2) << "finer ones do not help";
  EXPECT_EQ(best.error->rms_relative, 0.05);
  EXPECT_FALSE(meets_target(best));
  EXPECT_NE(steps.lines.back().find("and the one before is kept"), std::string::npos) << steps.lines.back();
}

TEST(RepeatToTarget, CountsTheMatrixInWhatTheNextRoundIsExpectedToTake) {
  Steps steps;
  Settings settings = asking_for(0.04, Method::jacobi);
  settings.max_element = 0.5;  // so that no round has more patches
  int rounds = 0;
  repeat_to_target(settings, steps, [&](Settings&, const Monitor&, StageSeconds&) {
    return std::optional(with_error(++rounds == 1 ? 0.08 : 0.01, 0));
  });
  ASSERT_EQ(steps.lines.size(), 1u);
  // 1,000 x 1,000 factors are the most of it.
  const std::size_t matrix = form_factor_bytes(1000);
  const std::string& line = steps.lines[0];
  const std::string memory = line.substr(line.rfind(" and ") + 5);
  EXPECT_GE(std::stod(memory), static_cast<double>(matrix) / (1 << 20)) << line;
  EXPECT_TRUE(memory.ends_with("MiB")) << line;
}

}  // namespace
}  // namespace clerestory
