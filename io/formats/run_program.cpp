#include "io/formats/run_program.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/formats/child_process.h"
#include "io/text.h"

namespace clerestory {
namespace {

constexpr auto kLook = std::chrono::milliseconds(100);
constexpr std::size_t kComplaint = 4096;  // bytes kept of standard error

/// Only what may be done between fork and exec in a process of threads.
[[noreturn]] void be_the_program(char* const* command, char* const* environment, int in, int out, int complaints,
                                 std::uint64_t cpu_seconds, pid_t parent) {
  begin_child(parent, cpu_seconds);
  dup2(in, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(complaints, STDERR_FILENO);
  execve(command[0], command, environment);
  _exit(127);
}

/// Bytes of memory that a process holds; 0 when unknown.
std::uint64_t resident_bytes(pid_t process) {
  std::uint64_t bytes = 0;
  if (std::FILE* file = std::fopen(text("/proc/", process, "/statm").c_str(), "re")) {
    unsigned long long all = 0, resident = 0;
    if (std::fscanf(file, "%llu %llu", &all, &resident) == 2)
      bytes = resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    std::fclose(file);
  }
  return bytes;
}

/// Reads what is there; false at the end.
bool read_some(int from, std::string& block, std::string& to) {
  const ssize_t n = read(from, block.data(), block.size());
  if (n < 0) return errno == EINTR || errno == EAGAIN;
  to.append(block.data(), static_cast<std::size_t>(n));
  return n > 0;
}

/// The line that says what went wrong: the first with "Error: " in it, else the last.
std::string telling_line(std::string complaints) {
  const std::size_t end = complaints.find_last_not_of(" \t\r\n");
  if (end == complaints.npos) return {};
  complaints.resize(end + 1);
  const std::size_t at = std::min(complaints.find("Error: "), end);
  const std::size_t begin = complaints.rfind('\n', at) + 1;  // npos + 1 is 0
  return quotable(complaints.substr(begin, complaints.find('\n', at) - begin), 160);
}

/// Until both streams end. Returns why it was ended before, or nothing.
std::string listen(pid_t child, int out, int complaints, const ProgramLimits& limits, std::string& answer,
                   std::string& complaint) {
  const auto start = std::chrono::steady_clock::now();
  std::string block(1 << 16, '\0');
  bool open[2] = {true, true};
  auto next_look = start + kLook;
  const std::uint64_t memory = std::min(limits.memory_bytes, physical_bytes());
  while (open[0] || open[1]) {
    pollfd ready[2] = {{open[0] ? out : -1, POLLIN, 0}, {open[1] ? complaints : -1, POLLIN, 0}};
    poll(ready, 2, static_cast<int>(kLook.count()));
    if (ready[0].revents != 0) open[0] = read_some(out, block, answer);
    if (ready[1].revents != 0) {
      open[1] = read_some(complaints, block, complaint);
      if (complaint.size() > 2 * kComplaint) complaint.erase(0, complaint.size() - kComplaint);
    }
    if (answer.size() > limits.answer_bytes) return "answers too much";
    const auto now = std::chrono::steady_clock::now();
    if (now < next_look) continue;
    next_look = now + kLook;
    if (now - start > limits.time) return text("took longer than ", limits.time.count(), " s");
    if (resident_bytes(child) > memory) return text("needed more than ", memory >> 20, " MiB of memory");
  }
  return {};
}

}  // namespace

void run_program(const std::vector<std::string>& command, const std::filesystem::path& input,
                 const ProgramLimits& limits, std::string& answer) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const char* path = std::getenv("PATH");
  const std::string path_of = std::string("PATH=") + (path ? path : "/usr/bin:/bin");
  char* const environment[] = {const_cast<char*>(path_of.c_str()), nullptr};

  const Descriptor in(open(input.c_str(), O_RDONLY));
  if (in.get() < 0) throw ProgramFailure(text("cannot open it: ", std::strerror(errno)));
  Pipe out = Pipe::make(), complaints = Pipe::make();
  const pid_t self = getpid();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error(text("cannot start a process: ", std::strerror(errno)));
  if (child == 0) {
    be_the_program(words.data(), environment, in.get(), out.in.get(), complaints.in.get(),
                   static_cast<std::uint64_t>(limits.cpu_time.count()), self);
  }
  out.in.close();
  complaints.in.close();
  std::string why, complaint;
  std::exception_ptr trouble;  // no memory for the answer: the child must still be waited for
  try {
    why = listen(child, out.out.get(), complaints.out.get(), limits, answer, complaint);
  } catch (...) {
    trouble = std::current_exception();
  }
  if (!why.empty() || trouble) kill(child, SIGKILL);
  const int status = status_of(child);
  if (trouble) std::rethrow_exception(trouble);
  if (!why.empty()) throw ProgramFailure(why);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    throw ProgramFailure(text("took longer than ", limits.cpu_time.count(), " s"));
  const std::string said = telling_line(complaint);
  throw ProgramFailure(said.empty() ? "crashed" : text("ended with: ", said));
}

std::string find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::string rest = path ? path : "/usr/local/bin:/usr/bin:/bin";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const std::string file = rest.substr(0, end) + "/" + name;
    if (end > 0 && access(file.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(file)) return file;
    rest.erase(0, end + 1);
  }
  return {};
}

}  // namespace clerestory
