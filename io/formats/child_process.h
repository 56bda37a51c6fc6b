#pragma once
// What child processes have in common: pipes to them, and what they may take.

#include <cstdint>
#include <optional>

#include <sys/resource.h>
#include <sys/types.h>

namespace clerestory {

/// A file descriptor that is closed at the end and on exec, and is none of 0, 1, 2, which children need.
class Descriptor {
 public:
  explicit Descriptor(int fd);
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  int get() const { return fd_; }
  void close();

 private:
  int fd_ = -1;
};

struct Pipe {
  Descriptor out, in;  ///< to read from, to write to
  /// throws  std::runtime_error when the system has none left.
  static Pipe make();
};

/// Lowers a limit of this process to `value`; one that is lower already stays.
void limit(decltype(RLIMIT_CORE) what, std::uint64_t value);

/// To be called first in a child of `parent`, and only what may be called between fork and exec: it ends with its
/// parent, does not know the parent's signal handlers, leaves Ctrl-C to the parent, writes no core and has so much
/// processor time.
void begin_child(pid_t parent, std::uint64_t cpu_seconds);

/// Waits for the child to end. returns  its status, as waitpid() has it.
int status_of(pid_t child);

/// Bytes of memory that this machine has.
std::uint64_t physical_bytes();

/// Bytes of address space that this process may take in all (ulimit -v); nothing when that is not limited.
std::optional<std::uint64_t> address_space_limit();

}  // namespace clerestory
