#include "apps/interrupt.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <string_view>

#include <sys/time.h>
#include <unistd.h>

#include "apps/exit_code.h"
#include "io/atomic_file.h"

namespace clerestory {
namespace {

// What a signal handler can reach.
std::atomic<bool> interrupted{false}, has_result{false};
std::atomic<int> log_descriptor{-1};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void say(int to, std::string_view line) {
  while (!line.empty()) {
    const ssize_t taken = ::write(to, line.data(), line.size());
    if (taken <= 0) return;
    line.remove_prefix(static_cast<std::size_t>(taken));
  }
}

void warn(std::string_view line) {
  if (::isatty(STDERR_FILENO) == 1) say(STDERR_FILENO, "\r\033[K");  // over the progress bar
  say(STDERR_FILENO, line);
  if (const int log = log_descriptor.load(); log >= 0) say(log, line);
}

[[noreturn]] void die_of(int signal) {
  std::signal(signal, SIG_DFL);
  sigset_t only;
  sigemptyset(&only), sigaddset(&only, signal);
  ::sigprocmask(SIG_UNBLOCK, &only, nullptr);
  ::raise(signal);
  ::_exit(128 + signal);
}

extern "C" void on_end(int signal) {
  const int error = errno;
  const bool first = !interrupted.exchange(true);
  const bool stays = has_result.load() && (first || signal == SIGXCPU);  // SIGXCPU comes again every second
  if (stays && first) {
    warn("interrupted: what is solved is about to be written. Once more ends at once, without.\n");
  } else if (!stays && remove_temporaries()) {
    if (!first) die_of(signal);
    warn("warning: interrupted before there was a result; nothing is written.\n");
    ::_exit(kInterrupted);
  }
  errno = error;
}

extern "C" void on_time_limit(int) {
  const int error = errno;
  if (!has_result.load() && remove_temporaries()) {
    warn(
        "warning: the time limit came before there was a result; nothing is written. Give it more time, or a larger "
        "--max-element.\n");
    ::_exit(kAccuracyNotReached);
  }
  errno = error;
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

bool is_ignored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

const std::atomic<bool>& catch_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGXCPU}) handle(signal, on_end);
  if (!is_ignored(SIGHUP)) handle(SIGHUP, on_end);  // nohup
  for (const int signal : {SIGPIPE, SIGXFSZ}) handle(signal, SIG_IGN);
  return interrupted;
}

void keep_result_when_interrupted() { has_result = true; }

void end_without_result_at(std::chrono::steady_clock::time_point time) {
  using namespace std::chrono;
  const auto left = duration_cast<microseconds>(time - steady_clock::now());
  handle(SIGALRM, on_time_limit);
  itimerval timer{};
  const auto wait = std::max<long long>(left.count(), 1);
  timer.it_value.tv_sec = static_cast<time_t>(wait / 1'000'000);
  timer.it_value.tv_usec = static_cast<suseconds_t>(wait % 1'000'000);
  ::setitimer(ITIMER_REAL, &timer, nullptr);
}

void log_ends_to(int descriptor) { log_descriptor = descriptor; }

}  // namespace clerestory
