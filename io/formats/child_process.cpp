#include "io/formats/child_process.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "io/text.h"

namespace clerestory {

Descriptor::Descriptor(int fd) {
  if (fd < 0) return;
  fd_ = fcntl(fd, F_DUPFD_CLOEXEC, 3);
  ::close(fd);
}

void Descriptor::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

Pipe Pipe::make() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error(text("cannot make a pipe: ", std::strerror(errno)));
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

void limit(decltype(RLIMIT_CORE) what, std::uint64_t value) {
  rlimit bound{};
  getrlimit(what, &bound);
  if (value < bound.rlim_cur) bound.rlim_cur = value;  // RLIM_INFINITY is the largest number
  setrlimit(what, &bound);
}

void begin_child(pid_t parent, std::uint64_t cpu_seconds) {
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
  if (getppid() != parent) _exit(127);  // it ended before that was set
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE, SIGTERM, SIGXCPU, SIGXFSZ, SIGALRM})
    std::signal(signal, SIG_DFL);
  for (const int signal : {SIGINT, SIGHUP}) std::signal(signal, SIG_IGN);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, cpu_seconds);
}

int status_of(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

std::uint64_t physical_bytes() {
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::optional<std::uint64_t> address_space_limit() {
  rlimit bound{};
  if (getrlimit(RLIMIT_AS, &bound) != 0 || bound.rlim_cur == RLIM_INFINITY) return std::nullopt;
  return bound.rlim_cur;
}

}  // namespace clerestory
