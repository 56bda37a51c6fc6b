#include "apps/console.h"

#include <iostream>

#include <sys/resource.h>
#include <unistd.h>

#include "apps/interrupt.h"
#include "io/atomic_file.h"
#include "pipeline/wording.h"
#include "solver/model/error.h"
#include "solver/model/parallel.h"

namespace clerestory {

Console::Console(const CommonArguments& arguments)
    : quiet_(arguments.quiet),
      verbose_(arguments.verbose),
      interrupted_(catch_interrupts()),
      progress_line_(std::cerr, ::isatty(STDERR_FILENO) == 1, start_) {
  set_thread_count(arguments.threads);
  if (!arguments.report.empty()) check_writable(arguments.report);
  if (arguments.log.empty()) return;
  log_.open(arguments.log);
  if (!log_) throw InputError(arguments.log + ": the log cannot be written; choose another place for --log.");
}

void Console::log(const char* kind, const std::string& line) {
  if (log_.is_open()) log_ << "[" << rounded(elapsed(), 4) << " s] " << kind << line << std::endl;
}

void Console::say(const std::string& line) {
  log("", line);
  if (quiet_) return;
  progress_line_.clear();
  std::cout << line << std::endl;
}

void Console::warn(const std::string& line) {
  log("warning: ", line);
  warnings_.push_back(line);
  progress_line_.clear();
  std::cerr << "warning: " << line << std::endl;
}

void Console::fail(const std::string& line) {
  log("error: ", line);
  progress_line_.clear();
  std::cerr << "error: " << line << std::endl;
}

void Console::note(const std::string& line) {
  log("", line);
  if (!verbose_) return;
  progress_line_.clear();
  std::cerr << line << std::endl;
}

void Console::progress(std::string_view stage, double done) {
  if (stage_ != stage) {
    stage_ = stage;
    log("", stage_);
  }
  if (!quiet_) progress_line_.update(stage, done);
}

Monitor Console::monitor() {
  return {[this](std::string_view stage, double done) { progress(stage, done); }, [this] { return should_stop(); }};
}

double Console::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace clerestory
