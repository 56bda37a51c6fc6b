#include "io/formats/run_apart.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/formats/child_process.h"
#include "io/text.h"

namespace clerestory {
namespace {

constexpr int kExitDone = 0, kExitFailed = 1, kExitOutOfMemory = 2;

/// Bytes of address space that this process has mapped; 0 when unknown.
std::uint64_t mapped_bytes() {
  std::uint64_t pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    unsigned long long first = 0;
    if (std::fscanf(file, "%llu", &first) == 1) pages = first;
    std::fclose(file);
  }
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

[[noreturn]] void be_the_child(const std::function<std::string()>& work, const ApartLimits& limits, int out,
                               std::uint64_t address_space, pid_t parent) {
  begin_child(parent, static_cast<std::uint64_t>(limits.time.count()) + 1);
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) dup2(nowhere, STDERR_FILENO);
  limit(RLIMIT_AS, address_space);
  try {
    const std::string answer = work();
    for (std::size_t sent = 0; sent < answer.size();) {
      const ssize_t n = write(out, answer.data() + sent, answer.size() - sent);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) _exit(kExitFailed);
      sent += static_cast<std::size_t>(n);
    }
    _exit(kExitDone);  // and not exit: buffers and handlers belong to the parent
  } catch (const std::bad_alloc&) {
    _exit(kExitOutOfMemory);
  } catch (...) {
    _exit(kExitFailed);
  }
}

/// All the child writes, or nothing when it is late.
bool read_until(std::chrono::steady_clock::time_point deadline, int in, std::string& answer) {
  std::string block(1 << 16, '\0');
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return false;
    pollfd ready{in, POLLIN, 0};
    const int events = poll(&ready, 1, static_cast<int>(std::min<long long>(left.count(), 1000)));
    if (events < 0 && errno != EINTR) return true;
    if (events <= 0) continue;
    const ssize_t n = read(in, block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return true;
    answer.append(block.data(), static_cast<std::size_t>(n));
  }
}

}  // namespace

std::string run_apart(const std::function<std::string()>& work, const ApartLimits& limits) {
  Pipe pipe = Pipe::make();
  const std::uint64_t mapped = mapped_bytes();
  const std::optional<std::uint64_t> allowed = address_space_limit();
  const std::uint64_t memory = mapped + std::min(limits.memory_bytes, physical_bytes());
  const bool is_tight = allowed && *allowed < memory;
  const pid_t parent = getpid(), child = fork();
  if (child < 0) throw std::runtime_error(text("cannot start a process: ", std::strerror(errno)));
  if (child == 0) {
    pipe.out.close();
    be_the_child(work, limits, pipe.in.get(), mapped > 0 ? memory : RLIM_INFINITY, parent);
  }
  pipe.in.close();
  std::string answer;
  bool in_time = false;
  std::exception_ptr trouble;  // no memory for the answer: the child must still be waited for
  try {
    in_time = read_until(std::chrono::steady_clock::now() + limits.time, pipe.out.get(), answer);
  } catch (...) {
    trouble = std::current_exception();
  }
  pipe.out.close();
  if (!in_time) kill(child, SIGKILL);
  const int status = status_of(child);
  if (trouble) std::rethrow_exception(trouble);
  if (!in_time || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)) {
    throw ApartFailure(text("took longer than ", limits.time.count(), " s"));
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == kExitDone) return answer;
  const bool out_of_memory = WIFEXITED(status) && WEXITSTATUS(status) == kExitOutOfMemory;
  if (out_of_memory && is_tight) throw std::bad_alloc();
  if (out_of_memory) throw ApartFailure("ran out of memory");
  throw ApartFailure(is_tight
                         ? text("crashed, which the limit of ", *allowed >> 20, " MiB on memory (ulimit -v) may cause")
                         : "crashed");
}

}  // namespace clerestory
