#include "apps/console.h"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <utility>

#include <sys/resource.h>
#include <unistd.h>

#include "apps/interrupt.h"
#include "io/text.h"
#include "pipeline/wording.h"
#include "solver/model/error.h"
#include "solver/model/parallel.h"
#include "solver/model/version.h"

namespace clerestory {

namespace {

/// A log may be replaced before it is known what else the scene is read from: it is not there yet, or an older log.
bool is_free_for_log(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error) || std::filesystem::file_size(file, error) == 0) return true;
  std::string head(32, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  const std::size_t end = head.find_first_not_of("0123456789.e-+", 1);
  return head[0] == '[' && end != head.npos && end > 1 && head.compare(end, 4, " s] ") == 0;
}

}  // namespace

Console::Console(const CommonArguments& arguments, std::vector<NamedFile> files)
    : quiet_(arguments.quiet),
      verbose_(arguments.verbose),
      log_name_(arguments.log),
      files_(std::move(files)),
      interrupted_(catch_signals()),
      progress_line_(std::cerr, ::isatty(STDERR_FILENO) == 1, start_) {
  set_thread_count(arguments.threads);
  refuse_to_overwrite(files_);
  if (!arguments.report.empty()) check_writable(arguments.report);
  if (log_name_.empty()) return;
  log("", "clerestory " + std::string(kVersion));
  if (is_free_for_log(log_name_))
    open_log();
  else
    check_writable(log_name_);
}

Console::~Console() {
  progress_line_.clear();
  log_ends_to(-1);
  if (log_ >= 0) ::close(log_);
}

void Console::open_log() {
  AtomicFile file(log_name_);
  file.write(std::exchange(log_head_, {}));
  file.commit();
  log_ = file.release();
  log_ends_to(log_);
}

void Console::has_read(const std::vector<std::filesystem::path>& files) {
  refuse_to_overwrite(files_, files);
  if (!log_name_.empty() && log_ < 0) open_log();
}

void Console::commit(Outputs& outputs) {
  if (!unsaid_.empty()) throw InputError(unsaid_ + "; no output is replaced.");
  outputs.commit();
}

void Console::log(const char* kind, const std::string& line) {
  if (log_name_.empty()) return;
  std::string all = "[" + rounded(elapsed(), 4) + " s] " + kind + line + "\n";
  if (log_ < 0)
    log_head_ += all;
  else if (const std::string problem = write_to(log_, all); !problem.empty() && unsaid_.empty())
    unsaid_ = "--log " + log_name_ + ": cannot be written: " + problem;
}

void Console::say(const std::string& said) {
  const std::string line = message_line(said);
  log("", line);
  if (quiet_) return;
  progress_line_.clear();
  if (const std::string problem = write_to(STDOUT_FILENO, line + "\n"); !problem.empty() && unsaid_.empty())
    unsaid_ = "standard output cannot be written: " + problem;
}

void Console::warn(const std::string& said) {
  const std::string line = message_line(said);
  log("warning: ", line);
  warnings_.push_back(line);
  progress_line_.clear();
  std::cerr << "warning: " << line << std::endl;
}

void Console::fail(const std::string& said) {
  const std::string line = message_line(said);
  log("error: ", line);
  progress_line_.clear();
  std::cerr << "error: " << line << std::endl;
}

void Console::step(const std::string& line) {
  log("", line);
  progress_line_.clear();
  if (!quiet_) std::cerr << line << std::endl;
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

void Console::has_result() { keep_result_when_interrupted(); }

Monitor Console::monitor() {
  return {[this](std::string_view stage, double done) { progress(stage, done); }, [this] { return should_stop(); }};
}

double Console::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

std::size_t peak_memory_bytes() {
  // Not ru_maxrss where there is better: it counts what the process held that this one was started from.
  std::ifstream status("/proc/self/status");
  std::string word;
  for (std::size_t kib = 0; status >> word;)
    if (word == "VmHWM:" && status >> kib) return kib * 1024;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace clerestory
