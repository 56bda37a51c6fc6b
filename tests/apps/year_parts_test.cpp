// A year in parts: the same bytes as one run, after a kill too, and what merge refuses.

#include "pipeline/annual/year_parts.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <signal.h>

#include "io/read_result.h"
#include "solver/model/error.h"
#include "tests/support/even_weather.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

using Words = std::vector<std::string>;

/// A room with a window of two panes, each with blinds, and an opal sheet in it: blinds and light from behind take
/// part.
class YearInParts : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<TempFolder>();
    folder->write("room.obj", kRoom);
    folder->write("room.json", R"({ "geometry": [{ "file": "room.obj" }], "materials": {
        "west": { "type": "glass", "transmittance": 0.7, "blinds": { "transmittance": 0.05, "group": "west" } },
        "east": { "type": "glass", "transmittance": 0.7, "blinds": { "transmittance": 0.05, "group": "east" } },
        "opal": { "type": "diffuser", "transmittance": 0.5, "reflectance": 0.3 },
        "*": { "reflectance": [0.5, 0.4, 0.3] } },
        "sensors": [{ "name": "desk", "origin": [0.25, 0.25, 0.8], "u": [2.5, 0, 0], "v": [0, 2.5, 0], "spacing": 0.3,
                      "normal": [0, 0, 1] }] })");
    folder->write("year.epw", even_weather());
  }
  static void TearDownTestSuite() { folder.reset(); }

  static std::string in_folder(const std::string& name) { return *folder / name; }
  static constexpr const char* kHow[] = {"--accuracy", "draft",       "--max-element", "3",      "--detail",
                                         "0.1",        "--threshold", "300,500",       "--quiet"};
  static Words annual(const std::string& output, const Words& more = {}) {
    Words words = {"annual", in_folder("room.json"), "--weather", in_folder("year.epw"), "-o", in_folder(output)};
    words.insert(words.end(), std::begin(kHow), std::end(kHow));
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  /// The name of what such a run writes; it runs where that is not there yet.
  static std::string written(const std::string& name, const Words& options) {
    if (std::filesystem::exists(in_folder(name))) return name;
    const ProgramRun run = run_program(annual(name, options));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return name;
  }
  static std::string whole() { return written("whole.vtp", {}); }
  /// "part_2_of_3.vtp"; every other one by two threads.
  static std::string part(int i, int n) {
    return written("part_" + std::to_string(i) + "_of_" + std::to_string(n) + ".vtp",
                   {"--part", std::to_string(i) + "/" + std::to_string(n), "--threads", std::to_string(1 + i % 2)});
  }
  static ProgramRun merge(const std::vector<std::string>& names, const std::string& output) {
    Words words = {"merge"};
    for (const std::string& n : names) words.push_back(in_folder(n));
    words.insert(words.end(), {"-o", in_folder(output)});
    return run_program(words);
  }
  static void expect_whole(const std::string& merged) {
    whole();
    for (const char* end : {".vtp", ".json", ".sensors.csv"}) {
      const std::string expected = read_text(in_folder(std::string("whole") + end));
      EXPECT_FALSE(expected.empty()) << end;
      EXPECT_TRUE(read_text(in_folder(merged + end)) == expected) << end;
    }
  }
  /// What merge says when it refuses; it leaves no file.
  static std::string refusal(const std::vector<std::string>& names) {
    const ProgramRun run = merge(names, "refused.vtp");
    EXPECT_EQ(run.exit_code, 3) << run.err;
    for (const char* file : {"refused.vtp", "refused.json", "refused.sensors.csv"})
      EXPECT_FALSE(std::filesystem::exists(in_folder(file))) << file;
    return run.err;
  }

  static constexpr const char* kRoom =
      "o room\nusemtl wall\n"
      "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 0 0 2.5\nv 3 0 2.5\nv 3 3 2.5\nv 0 3 2.5\n"
      "v 0.5 0 1\nv 1.5 0 1\nv 2.5 0 1\nv 0.5 0 2\nv 1.5 0 2\nv 2.5 0 2\n"
      "v 0.5 1.5 1.5\nv 1.5 1.5 1.5\nv 1.5 2.5 1.5\nv 0.5 2.5 1.5\n"
      "f 1 2 3 4\nf 8 7 6 5\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n"
      "f 1 9 10 11 2\nf 2 11 14 6\nf 6 14 13 12 5\nf 5 12 9 1\n"
      "o west\nusemtl west\nf 9 12 13 10\no east\nusemtl east\nf 10 13 14 11\n"
      "o sheet\nusemtl opal\nf 15 16 17 18\n";

  static inline std::unique_ptr<TempFolder> folder;
};

TEST_F(YearInParts, MergedInAnyOrderIsTheWholeYearBitForBit) {
  const ProgramRun run = merge({part(2, 3), part(3, 3), part(1, 3)}, "merged.vtp");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("desk: sDA"), run.out.npos) << run.out;
  EXPECT_NE(run.out.find("blinds closed in"), run.out.npos) << run.out;
  expect_whole("merged");
}

TEST_F(YearInParts, OneOrTwoPartsAreTheWholeYearToo) {
  ASSERT_EQ(merge({part(1, 1)}, "of_one.vtp").exit_code, 0);
  expect_whole("of_one");
  ASSERT_EQ(merge({part(1, 2), part(2, 2)}, "of_two.vtp").exit_code, 0);
  expect_whole("of_two");
}

TEST_F(YearInParts, MergesPartsWhoseSceneWasNamedInAnotherWay) {
  Words words = annual("other_name.vtp", {"--part", "2/2"});
  words[1] = in_folder("./room.json");
  ASSERT_EQ(run_program(words).exit_code, 0);
  const ProgramRun run = merge({part(1, 2), "other_name.vtp"}, "of_two_names.vtp");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  expect_whole("of_two_names");
}

TEST_F(YearInParts, APartIsNoResultForOtherCommands) {
  const std::pair<const char*, const char*> outputs[] = {{"report", "a.html"}, {"bake", "a.ply"}, {"render", "a.png"}};
  for (const auto& [command, output] : outputs) {
    const ProgramRun run = run_program({command, in_folder(part(2, 3)), "-o", in_folder(output)});
    EXPECT_EQ(run.exit_code, 3) << command;
    EXPECT_NE(run.err.find("is part 2 of 3 of a year; merge it first"), run.err.npos) << run.err;
  }
  const ProgramRun mixed = run_program({"mix", in_folder(part(2, 3)), "-o", in_folder("mixed.vtp"), "--set", "sky=1"});
  EXPECT_EQ(mixed.exit_code, 3);
  EXPECT_NE(mixed.err.find("is part 2 of 3 of a year"), mixed.err.npos) << mixed.err;
}

TEST_F(YearInParts, APartHasNoFigureWhereItHasNoPoint) {
  const WrittenResult here = read_result(in_folder(part(2, 3))), all = read_result(in_folder(whole()));
  for (const char* array : {"DA_300", "illuminance"}) {
    const auto &a = here.of_points.at(array).value, &b = all.of_points.at(array).value;
    std::size_t others = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_TRUE(a[i] == b[i] || a[i] == -1) << array << ": " << a[i] << " is not " << b[i];
      others += a[i] == -1;
    }
    EXPECT_GT(others, a.size() / 3) << array;
    EXPECT_LT(others, a.size()) << array;
  }
  EXPECT_FALSE(std::filesystem::exists(in_folder("part_2_of_3.json"))) << "nothing lies beside a part";
}

TEST_F(YearInParts, AKilledPartIsRunAgainAloneByTheScriptsForSlurm) {
  // The scripts as they are shipped, with what Slurm sets for a task; all parts at once, as processes.
  const std::string scripts = CLERESTORY_SOURCE_DIR "/data/cluster/", parts = in_folder("cluster");
  std::string how;
  for (const char* word : kHow) how += std::string(" ") + word;
  folder->write("clerestory", "#!/bin/sh\nexec " CLERESTORY_PROGRAM " \"$@\"" + how +
                                  " --log \"$FOLDER/log_$SLURM_ARRAY_TASK_ID\"\n");
  std::filesystem::permissions(in_folder("clerestory"), std::filesystem::perms::owner_all);
  const std::string where = "PATH=" + in_folder("") + ":$PATH SCENE=" + in_folder("room.json") +
                            " WEATHER=" + in_folder("year.epw") + " FOLDER=" + parts;
  const auto task = [&](int i) {
    return "exec env " + where + " SLURM_ARRAY_TASK_ID=" + std::to_string(i) +
           " SLURM_ARRAY_TASK_COUNT=2 SLURM_CPUS_PER_TASK=1 bash " + scripts + "slurm_part.sh";
  };
  const std::string merging = where + " OUT=" + in_folder("from_cluster.vtp") + " bash " + scripts + "slurm_merge.sh";
  {
    Program first("/bin/sh", {"-c", task(1)}), second("/bin/sh", {"-c", task(2)});
    ASSERT_TRUE(second.waits_for("] error", parts + "/log_2"));  // before it computes its points
    second.signal(SIGKILL);
    EXPECT_EQ(second.wait().exit_code, 128 + SIGKILL);
    const ProgramRun one = first.wait();
    EXPECT_EQ(one.exit_code, 0) << one.err;
  }
  EXPECT_TRUE(std::filesystem::exists(parts + "/part_1.vtp"));
  EXPECT_FALSE(std::filesystem::exists(parts + "/part_2.vtp"));
  const ProgramRun repeated = Program("/bin/sh", {"-c", task(2)}).wait();
  ASSERT_EQ(repeated.exit_code, 0) << repeated.err;
  folder->write("clerestory", "#!/bin/sh\nexec " CLERESTORY_PROGRAM " \"$@\"\n");
  const ProgramRun merged = Program("/bin/sh", {"-c", merging}).wait();
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  expect_whole("from_cluster");
}

/// What a job's container runs: the one argument of its shell.
std::string line_of_job(const std::string& file) {
  const std::string job = read_text(CLERESTORY_SOURCE_DIR "/data/cluster/" + file);
  const std::size_t begin = job.find("- exec "), end = job.find("resources:");
  if (begin > end || end == job.npos) return "exit 99";
  std::string line = job.substr(begin + 2, end - begin - 2);
  std::ranges::replace(line, '\n', ' ');
  return line;
}

TEST_F(YearInParts, TheJobsForKubernetesMakeTheSameYear) {
  const std::string volume = in_folder("volume");
  std::filesystem::create_directory(volume);
  for (const auto& [from, to] :
       {std::pair("room.json", "office.json"), {"room.obj", "room.obj"}, {"year.epw", "city.epw"}})
    std::filesystem::copy_file(in_folder(from), volume + "/" + to);
  std::string how;
  for (const char* word : kHow) how += std::string(" ") + word;
  const auto pod = [&](const std::string& index, const std::string& file, const std::string& more) {
    std::string line = line_of_job(file);
    line.erase(0, std::string("exec ").size());  // a function stands for the program
    const ProgramRun run =
        Program("/bin/sh", {"-c", "more='" + more + "'; JOB_COMPLETION_INDEX=" + index + "; IFS=' '; cd " + volume +
                                      "; PARTS=2; clerestory() { " CLERESTORY_PROGRAM " \"$@\" $more; }; " + line})
            .wait();
    EXPECT_EQ(run.exit_code, 0) << run.err;
  };
  for (const char* index : {"0", "1"}) pod(index, "kubernetes_parts.yaml", how);
  pod("", "kubernetes_merge.yaml", "");
  whole();
  EXPECT_EQ(read_text(volume + "/year.sensors.csv"), read_text(in_folder("whole.sensors.csv")));
}

TEST_F(YearInParts, ByDaskIsTheSameYear) {
  if (std::system("python3 -c 'import distributed' 2>/dev/null") != 0) GTEST_SKIP() << "Dask is not installed";
  std::string line =
      "PATH=$(dirname " CLERESTORY_PROGRAM "):$PATH python3 " CLERESTORY_SOURCE_DIR "/data/cluster/dask_year.py " +
      in_folder("room.json") + " " + in_folder("year.epw") + " --parts 2 -o " + in_folder("by_dask.vtp") + " --";
  for (const char* word : kHow) line += std::string(" ") + word;
  const ProgramRun run = Program("/bin/sh", {"-c", line}).wait();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  expect_whole("by_dask");
}

TEST_F(YearInParts, MergeNamesWhatIsMissingOrThereTwice) {
  const std::string missing = refusal({part(2, 3)});
  EXPECT_NE(missing.find("is part 2 of 3, and there are no parts 1, 3; run them"), missing.npos) << missing;
  std::filesystem::copy_file(in_folder(part(2, 3)), in_folder("again.vtp"),
                             std::filesystem::copy_options::overwrite_existing);
  const std::string twice = refusal({part(2, 3), "again.vtp"});
  EXPECT_NE(twice.find(part(2, 3) + " and "), twice.npos) << twice;
  EXPECT_NE(twice.find("again.vtp: are both part 2 of 3"), twice.npos) << twice;
}

TEST_F(YearInParts, MergeRefusesPartsOfDifferentRunsAndSaysWhatDiffers) {
  const auto other = [&](const Words& more) {
    std::filesystem::remove(in_folder("other.vtp"));
    Words options = {"--part", "2/3"};
    options.insert(options.end(), more.begin(), more.end());
    written("other.vtp", options);
    const std::string said = refusal({part(1, 3), "other.vtp"});
    EXPECT_NE(said.find(part(1, 3)), said.npos) << said;
    EXPECT_NE(said.find("other.vtp: are parts of different runs"), said.npos) << said;
    return said;
  };
  const std::string schedule = other({"--schedule", "9-17"});
  EXPECT_NE(schedule.find("settings.schedule is 8-18 and 9-17"), schedule.npos) << schedule;
  folder->write("year.epw", even_weather() + "\n");
  const std::string weather = other({});
  folder->write("year.epw", even_weather());
  EXPECT_NE(weather.find("the contents of year.epw differ"), weather.npos) << weather;
  const std::string count = refusal({part(1, 3), part(2, 2)});
  EXPECT_NE(count.find("the one is of 3 parts, the other of 2"), count.npos) << count;
}

TEST_F(YearInParts, MergeRefusesPartsThatOverlap) {
  YearMerge merge;
  for (const int i : {1, 2, 3}) {
    WrittenResult read = read_result(in_folder(part(i, 3)));
    if (i == 2) read.year_tables.at("place").value[1] -= 1;  // its first point
    merge.add(std::move(read));
  }
  EXPECT_THROW(merge.finish(), InputError);
}

TEST_F(YearInParts, MergeRefusesWhatIsNoPart) {
  const std::string said = refusal({whole()});
  EXPECT_NE(said.find("whole.vtp: is no part of a year"), said.npos) << said;
  const std::string scene = refusal({"room.json"});
  EXPECT_NE(scene.find("room.json"), scene.npos) << scene;
}

TEST_F(YearInParts, MergeDoesNotWriteOverAPart) {
  for (const char* file : {"a.vtp", "b.vtp"}) folder->write(file, "a part, as good as any");
  const ProgramRun run = merge({"a.vtp", "b.vtp"}, "b.vtp");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("b.vtp: is the file of -o too"), run.err.npos) << run.err;
  EXPECT_EQ(read_text(in_folder("b.vtp")), "a part, as good as any");
}

TEST_F(YearInParts, WhatIsNoPartOfAnythingIsAWrongUsage) {
  for (const char* part :
       {"0/4", "5/4", "x", "1", "1/", "/2", "-1/2", "1.5/2", "1/0", "2/3/4", "1e0/2", "1/99999999"}) {
    const ProgramRun run = run_program(annual("none.vtp", {"--part", part}));
    EXPECT_EQ(run.exit_code, 2) << part;
    EXPECT_NE(run.err.find("is no part; give i/n"), run.err.npos) << run.err;
  }
  for (const char* option : {"--hours", "--honeybee", "--sensors-out"}) {
    const ProgramRun run = run_program(annual("none.vtp", {"--part", "1/2", option, in_folder("extra")}));
    EXPECT_EQ(run.exit_code, 2) << option;
    EXPECT_NE(run.err.find(option), run.err.npos) << run.err;
  }
}

}  // namespace
}  // namespace clerestory
