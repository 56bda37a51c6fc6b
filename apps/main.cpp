// clerestory: one program, one command a file in commands/.

#include <exception>
#include <iostream>
#include <new>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "apps/command_line.h"
#include "apps/run.h"
#include "io/atomic_file.h"

namespace clerestory {
namespace {

/// Whoever started this may have closed standard input, output or error. The first files to be opened would get their
/// numbers, and every message would go into them.
void open_standard_files() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(number, F_GETFD) < 0) ::open("/dev/null", number == STDIN_FILENO ? O_RDONLY : O_WRONLY);
}

/// As many files at once as the system allows: a folder of results has all of its files open until they are whole.
void allow_many_files() {
  rlimit files{};
  if (::getrlimit(RLIMIT_NOFILE, &files) != 0) return;
  files.rlim_cur = files.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &files);
}

/// What is thrown where nobody can catch it, as by a thread that a library makes.
[[noreturn]] void on_terminate() {
  remove_temporaries();
  try {
    if (const auto thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    std::cerr << "error: " << kOutOfMemory << std::endl;
    ::_exit(kInputRefused);
  } catch (const std::exception& e) {
    std::cerr << "error: internal failure: " << e.what() << kPleaseReport << std::endl;
    ::_exit(kInternalFailure);
  } catch (...) {  // the line below says all there is to say
  }
  std::cerr << "error: internal failure: ended without a reason" << kPleaseReport << std::endl;
  ::_exit(kInternalFailure);
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  using namespace clerestory;
  open_standard_files();
  allow_many_files();
  std::set_terminate(on_terminate);
  const auto asked = read_command_line(argc, argv);
  const Task* task = std::get_if<Task>(&asked);
  return task ? (*task)() : std::get<ExitCode>(asked);
}
