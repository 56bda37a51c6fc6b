#include "apps/timed_run.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string_view>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/formats/child_process.h"
#include "io/text.h"

namespace clerestory {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kLookMs = 100;
constexpr std::chrono::seconds kKindly{3};  ///< from SIGTERM to SIGKILL
constexpr std::size_t kMostErrors = 1 << 16;

double seconds(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

/// Until the child closes its standard error, which it does when it ends. Returns whether it was asked to.
bool listen(pid_t child, int errors, const std::function<bool()>& should_end, std::string& said) {
  std::string block(1 << 12, '\0');
  bool was_asked = false, was_killed = false;
  Clock::time_point asked{};
  for (;;) {
    pollfd ready{errors, POLLIN, 0};
    ::poll(&ready, 1, kLookMs);
    if (ready.revents != 0) {
      const ssize_t n = ::read(errors, block.data(), block.size());
      if (n == 0 || (n < 0 && errno != EINTR && errno != EAGAIN)) return was_asked;
      if (n > 0) said.append(block.data(), static_cast<std::size_t>(n));
      if (said.size() > 2 * kMostErrors) said.erase(0, said.size() - kMostErrors);
    }
    if (!was_asked && should_end()) {
      ::kill(child, SIGTERM);
      was_asked = true, asked = Clock::now();
    }
    if (was_asked && !was_killed && Clock::now() > asked + kKindly) {
      ::kill(child, SIGKILL);
      was_killed = true;
    }
  }
}

}  // namespace

TimedRun run_timed(const std::vector<std::string>& arguments, const std::function<bool()>& should_end) {
  constexpr const char* kThisProgram = "/proc/self/exe";
  std::vector<char*> words = {const_cast<char*>("clerestory")};
  for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const Descriptor nowhere(::open("/dev/null", O_RDWR | O_CLOEXEC));
  Pipe errors = Pipe::make();
  const pid_t self = ::getpid();
  const auto start = Clock::now();
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error(text("cannot start a process: ", std::strerror(errno)));
  if (child == 0) {  // only what may be done between fork and exec in a process of threads
    begin_child(self, std::numeric_limits<std::uint64_t>::max());
    ::dup2(nowhere.get(), STDIN_FILENO);
    ::dup2(nowhere.get(), STDOUT_FILENO);
    ::dup2(errors.in.get(), STDERR_FILENO);
    ::execv(kThisProgram, words.data());
    ::_exit(127);
  }
  errors.in.close();
  TimedRun run;
  std::string said;
  run.was_ended = listen(child, errors.out.get(), should_end, said);
  int status = 0;
  rusage usage{};
  while (::wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  run.wall_s = std::chrono::duration<double>(Clock::now() - start).count();
  run.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  for (std::string_view rest = said; !rest.empty();) run.errors.emplace_back(next_line(rest));
  return run;
}

}  // namespace clerestory
