#include "io/formats/run_apart.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

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

std::uint64_t physical_bytes() {
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void limit(decltype(RLIMIT_CORE) what, std::uint64_t value) {
  rlimit bound{};
  getrlimit(what, &bound);
  if (bound.rlim_max == RLIM_INFINITY || value < bound.rlim_max) bound.rlim_cur = value;
  setrlimit(what, &bound);
}

[[noreturn]] void be_the_child(const std::function<std::string()>& work, const ApartLimits& limits, int out,
                               std::uint64_t mapped, pid_t parent) {
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a child nobody waits for should not go on
#endif
  if (getppid() != parent) _exit(kExitFailed);
  // What signals do in the parent is not for the child: it owns no files. Ctrl-C reaches both, and the parent decides.
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE, SIGTERM, SIGXCPU, SIGXFSZ, SIGALRM})
    std::signal(signal, SIG_DFL);
  for (const int signal : {SIGINT, SIGHUP}) std::signal(signal, SIG_IGN);
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) dup2(nowhere, STDERR_FILENO);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(limits.time.count()) + 1);
  if (mapped > 0) limit(RLIMIT_AS, mapped + std::min(limits.memory_bytes, physical_bytes()));
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
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) throw std::runtime_error(text("cannot make a pipe: ", std::strerror(errno)));
  const std::uint64_t mapped = mapped_bytes();
  const pid_t parent = getpid(), child = fork();
  if (child < 0) {
    const int error = errno;
    close(pipe_ends[0]);
    close(pipe_ends[1]);
    throw std::runtime_error(text("cannot start a process: ", std::strerror(error)));
  }
  if (child == 0) {
    close(pipe_ends[0]);
    be_the_child(work, limits, pipe_ends[1], mapped, parent);
  }
  close(pipe_ends[1]);
  std::string answer;
  bool in_time = false;
  std::exception_ptr trouble;  // no memory for the answer: the child must still be waited for
  try {
    in_time = read_until(std::chrono::steady_clock::now() + limits.time, pipe_ends[0], answer);
  } catch (...) {
    trouble = std::current_exception();
  }
  close(pipe_ends[0]);
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (trouble) std::rethrow_exception(trouble);
  if (!in_time || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)) {
    throw ApartFailure(text("took longer than ", limits.time.count(), " s"));
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == kExitDone) return answer;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kExitOutOfMemory) throw ApartFailure("ran out of memory");
  throw ApartFailure("crashed");
}

}  // namespace clerestory
