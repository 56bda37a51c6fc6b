#pragma once
// Where a run speaks: results to standard output, all else to standard error, everything into the log.

#include <atomic>
#include <fstream>
#include <string>
#include <vector>

#include "apps/arguments.h"
#include "apps/progress_line.h"
#include "pipeline/observer.h"
#include "solver/model/monitor.h"

namespace clerestory {

class Console : public Observer {
 public:
  /// Also sets the number of threads and catches Ctrl-C.
  /// throws  InputError when the log or report cannot be written.
  explicit Console(const CommonArguments& arguments);
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;
  ~Console() override { progress_line_.clear(); }

  /// A line of the answer, to standard output unless --quiet.
  void say(const std::string& line);
  /// Kept for the report, too.
  void warn(const std::string& line) override;
  /// The one message of a run that fails.
  void fail(const std::string& line);
  /// For --verbose and the log.
  void note(const std::string& line) override;
  void progress(std::string_view stage, double done) override;
  /// After Ctrl-C.
  bool should_stop() const override { return interrupted_.load(); }

  /// For work outside of solve_scene().
  Monitor monitor();

  std::chrono::steady_clock::time_point start() const { return start_; }
  /// Seconds since the start.
  double elapsed() const;
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void log(const char* kind, const std::string& line);

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool quiet_, verbose_;
  const std::atomic<bool>& interrupted_;
  ProgressLine progress_line_;
  std::ofstream log_;
  std::vector<std::string> warnings_;
  std::string stage_;
};

/// Largest memory this process held so far.
std::size_t peak_memory_bytes();

}  // namespace clerestory
