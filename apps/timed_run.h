#pragma once
// This program again, as a process of its own: what it takes is told for that run alone.

#include <functional>
#include <string>
#include <vector>

namespace clerestory {

struct TimedRun {
  int exit_code = 0;                ///< 128 + signal when it was killed
  bool was_ended = false;           ///< because should_end() said so
  double wall_s = 0, cpu_s = 0;     ///< start and end of the process included; CPU with that of its own children
  std::vector<std::string> errors;  ///< lines of its standard error, the last ones
};

/// Runs this program with these arguments. Its standard output goes nowhere.
///
/// should_end  asked ten times a second; true ends the run, kindly first. It also ends when this process does.
/// throws      std::runtime_error when the system starts no process.
TimedRun run_timed(const std::vector<std::string>& arguments, const std::function<bool()>& should_end);

}  // namespace clerestory
