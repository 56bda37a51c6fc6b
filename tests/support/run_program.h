#pragma once
// Runs the program as a user would, and holds on to what it said.

#include <string>
#include <vector>

#include <sys/types.h>

#include "tests/support/temp_folder.h"

namespace clerestory {

struct ProgramRun {
  int exit_code = -1;  ///< 128 + signal when it was killed
  std::string out, err;
};

/// A run under way.
class Program {
 public:
  explicit Program(const std::vector<std::string>& arguments);
  /// Another program in place of ours.
  Program(std::string name, std::vector<std::string> arguments);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void signal(int number) const;
  bool running();
  /// Waits until `file` holds `text`; false when the run ends before.
  bool waits_for(const std::string& text, const std::string& file);
  ProgramRun wait();

 private:
  TempFolder folder_;
  pid_t process_ = -1;
  int status_ = 0;
};

ProgramRun run_program(const std::vector<std::string>& arguments);

/// Runs a line of /bin/sh in which $CLERESTORY is the program: for limits, redirections and pipes.
ProgramRun run_by_shell(const std::string& line);

/// A scene shipped with the program.
std::string shipped_scene(const std::string& name);

}  // namespace clerestory
