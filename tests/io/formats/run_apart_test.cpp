#include "io/formats/run_apart.h"

#include <csignal>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

namespace clerestory {
namespace {

std::string failure(const std::function<std::string()>& work, const ApartLimits& limits = {}) {
  try {
    return "answered " + run_apart(work, limits);
  } catch (const ApartFailure& error) {
    return error.what();
  }
}

TEST(RunApart, HandsBackWhatTheChildReturnsAndNothingElse) {
  int here = 1;
  EXPECT_EQ(run_apart(
                [&] {
                  here = 2;
                  return std::string(3'000'000, 'x');
                },
                {}),
            std::string(3'000'000, 'x'));
  EXPECT_EQ(here, 1);
}

TEST(RunApart, ACrashIsAFailureOfTheChildOnly) {
  EXPECT_EQ(failure([]() -> std::string {
              std::raise(SIGSEGV);
              return "";
            }),
            "crashed");
  EXPECT_EQ(failure([]() -> std::string { std::abort(); }), "crashed");
  EXPECT_EQ(failure([]() -> std::string { throw std::runtime_error("lost"); }), "crashed");
}

TEST(RunApart, AHangEndsAtTheLimit) {
  const auto hang = []() -> std::string {
    while (true) ::pause();
  };
  EXPECT_EQ(failure(hang, {.time = std::chrono::seconds(1)}), "took longer than 1 s");
}

TEST(RunApart, MemoryBeyondTheLimitIsNotGiven) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers answer a failed allocation by ending the process";
#endif
  EXPECT_EQ(failure(
                []() -> std::string {
                  std::vector<char> much(std::size_t{1} << 32, 'x');
                  return {much[1 << 20]};
                },
                {.memory_bytes = 100 << 20}),
            "ran out of memory");
}

TEST(RunApart, MemoryThatThisProcessIsNotAllowedIsNoFaultOfTheWork) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers take more address space than any limit";
#endif
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  rlimit tight = before;
  tight.rlim_cur = rlim_t{2} << 30;
  setrlimit(RLIMIT_AS, &tight);
  const auto eat = []() -> std::string {
    std::vector<char> much(std::size_t{1} << 32, 'x');
    return {much[1 << 20]};
  };
  EXPECT_THROW(run_apart(eat, {}), std::bad_alloc);
  EXPECT_EQ(failure([]() -> std::string { std::abort(); }),
            "crashed, which the limit of 2048 MiB on memory (ulimit -v) may cause");
  setrlimit(RLIMIT_AS, &before);
}

}  // namespace
}  // namespace clerestory
