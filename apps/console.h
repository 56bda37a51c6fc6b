#pragma once
// Where a run speaks: results to standard output, all else to standard error, everything into the log.

#include <fstream>
#include <string>
#include <vector>

#include "apps/arguments.h"
#include "apps/progress_line.h"
#include "solver/model/monitor.h"

namespace clerestory {

class Console {
 public:
  /// Also sets the number of threads and catches Ctrl-C.
  /// throws  InputError when the log or report cannot be written.
  explicit Console(const CommonArguments& arguments);
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;
  ~Console() { progress_.clear(); }

  /// A line of the answer, to standard output unless --quiet.
  void say(const std::string& line);
  /// Something the user should look at; kept for the report.
  void warn(const std::string& line);
  /// The one message of a run that fails.
  void fail(const std::string& line);
  /// For --verbose and the log.
  void note(const std::string& line);

  /// Shows progress, stops for Ctrl-C and at `deadline`.
  Monitor monitor(std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max());
  bool interrupted() const;

  /// Seconds since the start.
  double elapsed() const;
  /// Seconds spent in solver stages whose name starts with `name`.
  double seconds_in(const std::string& name) const;
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void log(const char* kind, const std::string& line);
  void on_progress(std::string_view stage, double done);

  struct Stage {
    std::string name;
    double begin = 0, end = 0;
  };
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool quiet_, verbose_;
  const std::atomic<bool>& interrupted_;
  ProgressLine progress_;
  std::ofstream log_;
  std::vector<std::string> warnings_;
  std::vector<Stage> stages_;
};

/// Largest memory this process held so far.
std::size_t peak_memory_bytes();

}  // namespace clerestory
