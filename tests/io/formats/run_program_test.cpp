#include "io/formats/run_program.h"

#include <csignal>
#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

class RunProgram : public ::testing::Test {
 protected:
  /// What a shell script answers, or how it failed.
  std::string run(const std::string& script, const ProgramLimits& limits = {}, const std::string& input = "") {
    answer_.clear();
    try {
      run_program({"/bin/sh", "-c", script}, folder_.write("input", input), limits, answer_);
      return "answered " + answer_;
    } catch (const ProgramFailure& failure) {
      return failure.what();
    }
  }
  TempFolder folder_;
  std::string answer_;
};

TEST_F(RunProgram, ReadsTheInputAndHandsBackTheAnswer) {
  const std::string much(3'000'000, 'x');
  EXPECT_EQ(run("cat", {}, much), "answered " + much);
}

TEST_F(RunProgram, SeesNoEnvironmentButThePath) {
  setenv("CLERESTORY_SECRET", "x", 1);
  EXPECT_EQ(run("echo \"$CLERESTORY_SECRET.$NODE_OPTIONS\"; command -v cat >/dev/null && echo found"),
            "answered .\nfound\n");
  unsetenv("CLERESTORY_SECRET");
}

TEST_F(RunProgram, SaysWhatItEndedWithAndKeepsWhatItAnswered) {
  EXPECT_EQ(run("printf half; echo 'at once'; echo 'Error: no such thing' >&2; echo 'Node.js v0' >&2; exit 3"),
            "ended with: Error: no such thing");
  EXPECT_EQ(answer_, "halfat once\n");
  EXPECT_EQ(run("kill -SEGV $$"), "crashed");
  EXPECT_EQ(run("exit 1"), "crashed");
}

TEST_F(RunProgram, EndsAtTheLimits) {
  EXPECT_EQ(run("sleep 60", {.time = std::chrono::seconds(1)}), "took longer than 1 s");
  EXPECT_EQ(run("while :; do :; done", {.cpu_time = std::chrono::seconds(1)}), "took longer than 1 s");
  EXPECT_EQ(run("yes", {.answer_bytes = 1 << 20}), "answers too much");
  EXPECT_EQ(run("x=$(head -c 40000000 /dev/zero | tr '\\0' x); sleep 60", {.memory_bytes = 20 << 20}),
            "needed more than 20 MiB of memory");
}

TEST_F(RunProgram, FindsProgramsInThePath) {
  EXPECT_FALSE(find_program("sh").empty());
  EXPECT_TRUE(find_program("no such program").empty());
}

}  // namespace
}  // namespace clerestory
