#pragma once
// A program of others, run apart with what it reads on its standard input and what it answers on its standard output.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace clerestory {

struct ProgramLimits {
  std::chrono::seconds cpu_time{60};                    ///< of all its threads
  std::chrono::seconds time{240};                       ///< on the clock, for a program that waits
  std::uint64_t memory_bytes = std::uint64_t{4} << 30;  ///< that it holds in memory, looked at ten times a second
  std::uint64_t answer_bytes = std::uint64_t{8} << 30;  ///< that it writes
};

/// The program ended without success. what() says how, to be put behind its name: "crashed", "took longer than 60 s",
/// "ended with: ..." and the line of its standard error that tells most.
class ProgramFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs command[0], a path, with the others as arguments and `input` as standard input, and adds what it writes to
/// `answer`, also when it fails. It sees no environment but PATH, and ends when this process does.
///
/// throws   ProgramFailure when it ended with another code than 0, by a signal or beyond a limit.
/// Limits:  POSIX only; the memory limit needs /proc.
void run_program(const std::vector<std::string>& command, const std::filesystem::path& input,
                 const ProgramLimits& limits, std::string& answer);

/// Path of a program of this name in the folders of PATH; empty when there is none.
std::string find_program(const std::string& name);

}  // namespace clerestory
