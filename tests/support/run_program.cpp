#include "tests/support/run_program.h"

#include <chrono>
#include <thread>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace clerestory {
namespace {

void redirect(int to, const std::string& file) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  ::dup2(descriptor, to);
  ::close(descriptor);
}

}  // namespace

Program::Program(const std::vector<std::string>& arguments) : Program(CLERESTORY_PROGRAM, arguments) {}

Program::Program(std::string name, std::vector<std::string> arguments) {
  std::vector<char*> argv{name.data()};
  for (std::string& word : arguments) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string out = folder_ / "out", err = folder_ / "err";
  process_ = ::fork();
  if (process_ != 0) return;
  redirect(STDOUT_FILENO, out);
  redirect(STDERR_FILENO, err);
  ::execv(name.c_str(), argv.data());
  ::_exit(127);
}

Program::~Program() {
  if (!running()) return;
  signal(SIGKILL);
  ::waitpid(process_, &status_, 0);
}

void Program::signal(int number) const { ::kill(process_, number); }

bool Program::running() {
  if (process_ < 0) return false;
  if (::waitpid(process_, &status_, WNOHANG) == process_) process_ = -1;
  return process_ >= 0;
}

bool Program::waits_for(const std::string& text, const std::string& file) {
  while (read_text(file).find(text) == std::string::npos) {
    if (!running()) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));  // only how often it looks
  }
  return true;
}

ProgramRun Program::wait() {
  if (process_ >= 0) ::waitpid(process_, &status_, 0);
  process_ = -1;
  const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  return {code, read_text(folder_ / "out"), read_text(folder_ / "err")};
}

ProgramRun run_program(const std::vector<std::string>& arguments) { return Program(arguments).wait(); }

ProgramRun run_by_shell(const std::string& line) {
  return Program("/bin/sh", {"-c", "CLERESTORY=" CLERESTORY_PROGRAM "; " + line}).wait();
}

std::string shipped_scene(const std::string& name) { return CLERESTORY_SOURCE_DIR "/data/scenes/" + name; }

}  // namespace clerestory
