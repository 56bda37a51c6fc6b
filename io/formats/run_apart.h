#pragma once
// Work that may crash, hang or eat memory, done in a child process: a third-party importer on a damaged file does all
// three, and takes only the child with it.

#include <chrono>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace clerestory {

struct ApartLimits {
  std::chrono::seconds time{60};
  std::uint64_t memory_bytes = std::uint64_t{4} << 30;  ///< beyond what this process has mapped
};

/// The child ended without an answer. what() says how: "crashed", "took longer than 60 s", ...
class ApartFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs work() in a child process and returns what it returned. The child shares nothing else: what work() changes
/// stays there. Its standard error goes nowhere.
///
/// throws   ApartFailure when the child ended another way or went over a limit; std::bad_alloc when a limit that this
///          process has itself (ulimit -v) left it too little memory.
/// Limits:  POSIX only (fork). work() must not use threads of this process or locks that they may hold.
std::string run_apart(const std::function<std::string()>& work, const ApartLimits& limits);

}  // namespace clerestory
