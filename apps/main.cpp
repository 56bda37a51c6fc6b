// clerestory: one program, one command a file in commands/.

#include "apps/command_line.h"

int main(int argc, char** argv) {
  using namespace clerestory;
  const auto asked = read_command_line(argc, argv);
  const Task* task = std::get_if<Task>(&asked);
  return task ? (*task)() : std::get<ExitCode>(asked);
}
