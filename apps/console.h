#pragma once
// Where a run speaks: results to standard output, all else to standard error, everything into the log.

#include <atomic>
#include <string>
#include <vector>

#include "apps/arguments.h"
#include "apps/named_files.h"
#include "apps/progress_line.h"
#include "io/atomic_file.h"
#include "pipeline/observer.h"
#include "solver/model/monitor.h"

namespace clerestory {

class Console : public Observer {
 public:
  /// Also sets the number of threads and catches signals.
  ///
  /// files   all that the command line names; the input is the first of them.
  /// throws  InputError when one that is written is also read, or written twice, or cannot be written.
  Console(const CommonArguments& arguments, std::vector<NamedFile> files);
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;
  ~Console() override;

  /// A line of the answer, to standard output unless --quiet.
  void say(const std::string& line);
  /// Kept for the report, too.
  void warn(const std::string& line) override;
  /// The one message of a run that fails.
  void fail(const std::string& line);
  /// A step of the work is done: a line to standard error unless --quiet.
  void step(const std::string& line) override;
  /// For --verbose and the log.
  void note(const std::string& line) override;
  void progress(std::string_view stage, double done) override;
  void has_result() override;
  /// After Ctrl-C.
  bool should_stop() const override { return interrupted_.load(); }

  /// The scene is read, from these files. A log that is there already is replaced from now on.
  /// throws  InputError when one of them is also written.
  void has_read(const std::vector<std::filesystem::path>& files);
  /// Renames all outputs, when all that was said was taken, too.
  /// throws  InputError when the disk is full, under the log or standard output too; no output is replaced then.
  void commit(Outputs& outputs);

  /// For work outside of solve_scene().
  Monitor monitor();

  std::chrono::steady_clock::time_point start() const { return start_; }
  /// Seconds since the start.
  double elapsed() const;
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void open_log();
  void log(const char* kind, const std::string& line);

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool quiet_, verbose_;
  std::string log_name_;
  std::vector<NamedFile> files_;
  const std::atomic<bool>& interrupted_;
  ProgressLine progress_line_;
  int log_ = -1;          ///< descriptor
  std::string log_head_;  ///< what the log has before it is open
  std::string unsaid_;    ///< why a line was not taken: of the log or of standard output
  std::vector<std::string> warnings_;
  std::string stage_;
};

/// Largest memory this process held so far.
std::size_t peak_memory_bytes();

}  // namespace clerestory
