// Signals and limits of time and memory: the program ends, says why, and keeps old files.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <signal.h>
#include <sys/stat.h>

#include "tests/support/box_scene.h"
#include "tests/support/result_file.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

/// Paths go over all elements in rounds; from the first of them on there is something to write.
std::vector<std::string> solve_by_paths(const std::string& output, const std::string& max_element) {
  return {"solve",
          shipped_scene("office.json"),
          "-o",
          output,
          "--method",
          "path",
          "--accuracy",
          "draft",
          "--max-element",
          max_element};
}

/// A solve with half a minute of paths before it.
class LongRun {
 public:
  explicit LongRun(const std::string& output) : program_(arguments(output)) {}

  /// Sends the signal once paths are under way.
  ProgramRun signalled(int number) {
    EXPECT_TRUE(program_.waits_for("] paths", log())) << "it ended without";
    program_.signal(number);
    return program_.wait();
  }

 private:
  std::string log() const { return elsewhere_ / "log"; }
  std::vector<std::string> arguments(const std::string& output) const {
    std::vector<std::string> words = solve_by_paths(output, "0.1");
    words.insert(words.end(), {"--log", log()});
    return words;
  }
  TempFolder elsewhere_;
  Program program_;
};

TEST(Interrupt, CtrlCWritesWhatThereIsAndExitsFive) {
  const TempFolder folder;
  const ProgramRun run = LongRun(folder / "out.vtp").signalled(SIGINT);
  EXPECT_EQ(run.exit_code, 5) << run.err;
  const ResultFile result = read_result(folder / "out.vtp");
  EXPECT_GT(result.triangles.size(), 10'000u);
  for (const auto& arrays : {result.of_cells, result.of_points})
    for (const auto& [name, array] : arrays)
      for (const double value : array.values) ASSERT_TRUE(std::isfinite(value)) << name;
  EXPECT_EQ(result.texts.at("stop"), std::vector<std::string>{"interrupted"});
  EXPECT_EQ(folder.listing(), "out.sensors.csv out.vtp ");
}

TEST(Interrupt, AKilledRunLeavesNoHalfFileAndTheOldResultAlone) {
  const TempFolder folder;
  folder.write("out.vtp", "the result of yesterday");
  EXPECT_EQ(LongRun(folder / "out.vtp").signalled(SIGKILL).exit_code, 128 + SIGKILL);
  EXPECT_EQ(read_text(folder / "out.vtp"), "the result of yesterday");
  EXPECT_EQ(folder.listing(), "out.vtp ");
}

TEST(TimeLimit, ReachedBeforeTheEndIsExitFourWithAResult) {
  // No machine has done by then, so the first round of paths is all there is, on every machine; few elements, so that
  // there is something within the second and a half that a run may go over its limit.
  const TempFolder folder;
  auto arguments = solve_by_paths(folder / "out.vtp", "2");
  arguments.insert(arguments.end(), {"--time-limit", "0.001"});
  const ProgramRun run = run_program(arguments);
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_NE(run.err.find("time limit of 0.001"), std::string::npos) << run.err;
  const ResultFile result = read_result(folder / "out.vtp");
  EXPECT_EQ(result.texts.at("stop"), std::vector<std::string>{"time-limit"});
  const auto& E = result.of_cells.at("irradiance").values;
  EXPECT_GT(*std::max_element(E.begin(), E.end()), 0);
}

/// Runs that take minutes, in the stage that their log names when a signal comes. There is no result to write then.
struct LongStage {
  std::vector<std::string> arguments;
  const char* stage;
};

std::vector<LongStage> long_stages(const std::string& vtp, const std::string& csv) {
  const std::string house = shipped_scene("house.json");
  return {{{"mesh", house, "-o", vtp, "--max-element", "0.02"}, "] mesh"},
          {{"solve", house, "-o", vtp, "--max-element", "0.02"}, "] mesh"},
          {{"formfactors", house, "-o", csv, "--by", "patch"}, "] form factors"}};
}

TEST(Interrupt, BeforeThereIsAResultTheProgramEndsAtOnceAndOldFilesStay) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) {
    const TempFolder folder, elsewhere;
    folder.write("old.vtp", "of yesterday"), folder.write("old.csv", "of yesterday");
    for (auto [arguments, stage] : long_stages(folder / "old.vtp", folder / "old.csv")) {
      SCOPED_TRACE(arguments[0] + ", signal " + std::to_string(number));
      const std::string log = elsewhere / arguments[0];
      arguments.insert(arguments.end(), {"--log", log});
      Program program(arguments);
      ASSERT_TRUE(program.waits_for(stage, log));
      program.signal(number);
      const ProgramRun run = program.wait();
      EXPECT_EQ(run.exit_code, 5) << run.err;
      EXPECT_NE(run.err.find("nothing is written"), std::string::npos) << run.err;
      EXPECT_NE(read_text(log).find("nothing is written"), std::string::npos);
      EXPECT_EQ(read_text(folder / "old.vtp") + read_text(folder / "old.csv"), "of yesterdayof yesterday");
      EXPECT_EQ(folder.listing(), "old.csv old.vtp ");
    }
  }
}

TEST(Interrupt, ASeriesHasNoResultBeforeItsLightIsPartedAmongTheTimes) {
  const TempFolder folder, elsewhere;
  Program program({"solve", shipped_scene("office_march.json"), "-o", folder / "day.pvd", "--accuracy", "fine",
                   "--times", "2026-03-21T06:00/20:00/PT1H", "--log", elsewhere / "log"});
  ASSERT_TRUE(program.waits_for("] gather", elsewhere / "log"));  // a round for the mean light is all but done
  program.signal(SIGINT);
  const ProgramRun run = program.wait();
  EXPECT_EQ(run.exit_code, 5) << run.err;
  EXPECT_NE(run.err.find("interrupted before there was a result; nothing is written"), std::string::npos) << run.err;
  EXPECT_EQ(folder.listing(), "");
}

TEST(Interrupt, ASecondOneEndsAtOnceAndRemovesTemporaryFiles) {
  // All is solved, and the program waits for somebody to read the pipe; beside it lies the table of the sensors.
  const TempFolder folder, elsewhere;
  ASSERT_EQ(::mkfifo((folder / "pipe.vtp").c_str(), 0600), 0);
  const std::string sensors = elsewhere.write("s.csv", "1,1,1,0,0,1\n");
  Program program({"solve", BoxScene{}.write(elsewhere), "-o", folder / "pipe.vtp", "--sensors", sensors,
                   "--max-element", "1", "--log", elsewhere / "log"});
  ASSERT_TRUE(program.waits_for("energy", elsewhere / "log"));
  for (int k = 0; k < 2; ++k) program.signal(SIGINT), program.signal(SIGTERM);
  const int code = program.wait().exit_code;
  EXPECT_TRUE(code == 128 + SIGINT || code == 128 + SIGTERM) << code;
  EXPECT_EQ(folder.listing(), "pipe.vtp ");
}

TEST(Interrupt, NobodyWhoReadsStandardOutputIsNoReasonToEnd) {
  const TempFolder folder;
  const std::string scene = BoxScene{}.write(folder);
  const ProgramRun run = run_by_shell("{ $CLERESTORY solve " + scene + " --max-element 1 -o " + (folder / "out.vtp") +
                                      "; echo $? > " + (folder / "code") + "; } | true");
  EXPECT_EQ(read_text(folder / "code"), "0\n") << run.err;
  EXPECT_GT(read_result(folder / "out.vtp").triangles.size(), 0u);
}

TEST(TimeLimit, IsNoneWhenItIsBeyondAllTime) {
  const TempFolder folder;
  const std::string scene = BoxScene{}.write(folder);
  for (const char* limit : {"1e9", "1e10", "1e300"}) {
    const ProgramRun run =
        run_program({"solve", scene, "-o", folder / "out.vtp", "--max-element", "1", "--time-limit", limit});
    EXPECT_EQ(run.exit_code, 0) << limit << "\n" << run.err;
  }
}

TEST(TimeLimit, EndsReadingAndMeshingWithoutAResult) {
  const TempFolder folder;
  folder.write("out.vtp", "of yesterday");
  const ProgramRun run = run_program(
      {"solve", shipped_scene("house.json"), "-o", folder / "out.vtp", "--max-element", "0.02", "--time-limit", "0.5"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_NE(run.err.find("nothing is written"), std::string::npos) << run.err;
  EXPECT_EQ(read_text(folder / "out.vtp"), "of yesterday");
  EXPECT_EQ(folder.listing(), "out.vtp ");
}

TEST(TimeLimit, EndsTheMeasuringOfErrorsWherePathsHaveAMillionBounces) {
  const TempFolder folder;
  const std::string scene = BoxScene{.rho = 0.999999}.write(folder);
  const ProgramRun run = run_program({"solve", scene, "-o", folder / "out.vtp", "--accuracy", "draft", "--max-element",
                                      "1", "--time-limit", "3", "--report", folder / "r.json"});
  EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 4) << run.err;  // whether the elements were solved by then
  const Json report = Json::parse(read_text(folder / "r.json"));
  EXPECT_TRUE(report["error"].is_null() || report["error"]["samples"] < 4096) << report["error"];
  EXPECT_GT(read_result(folder / "out.vtp").triangles.size(), 0u);
}

TEST(MemoryOfTheSystem, WhenItIsShortTheProgramSaysSo) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers map terabytes";
#endif
  const TempFolder folder;
  const std::string scene = BoxScene{}.write(folder);
  const std::string house = shipped_scene("house.json");
  for (const int kilobytes : {300'000, 400'000, 600'000, 1'000'000, 2'000'000}) {
    for (const std::string& command : {"check " + house, "mesh " + house + " -o " + (folder / "m.vtp"),
                                       "solve " + scene + " --accuracy draft -o " + (folder / "out.vtp")}) {
      SCOPED_TRACE(command + ", " + std::to_string(kilobytes));
      const ProgramRun run = run_by_shell("ulimit -v " + std::to_string(kilobytes) + "; exec $CLERESTORY " + command);
      EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 3) << run.exit_code << "\n" << run.err;
      EXPECT_EQ(run.exit_code == 3, run.err.find("out of memory") != std::string::npos) << run.err;
    }
  }
}

}  // namespace
}  // namespace clerestory
