// The folder of a sweep for files in between.

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "apps/sweep.h"
#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

TEST(WorkFolder, RemovesWhatNobodyHoldsAndLeavesTheOthers) {
  const TempFolder folder;
  fs::create_directory(folder / ".sweep-killed");
  folder.write(".sweep-killed/run.vtp", "half");
  const WorkFolder first(folder / ".");
  EXPECT_FALSE(fs::exists(folder / ".sweep-killed"));
  {
    const WorkFolder second(folder / ".");
    EXPECT_TRUE(fs::is_directory(first.path()));
    EXPECT_NE(first.path(), second.path());
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "."), fs::directory_iterator()), 1);
}

TEST(WorkFolder, SweepsThatStartTogetherDoNotTakeEachOthers) {
  const TempFolder folder;
  std::atomic<int> lost = 0;
  std::vector<std::thread> sweeps;
  for (int k = 0; k < 4; ++k)
    sweeps.emplace_back([&] {
      for (int round = 0; round < 500; ++round) {
        const WorkFolder work(folder / ".");
        std::ofstream(work.path() / "run.vtp") << "mine";
        std::this_thread::yield();
        if (!fs::exists(work.path() / "run.vtp")) ++lost;
      }
    });
  for (std::thread& sweep : sweeps) sweep.join();
  EXPECT_EQ(lost, 0);
}

}  // namespace
}  // namespace clerestory
