#pragma once
// The commands of the program: one file each. To add one, write commands/NAME.cpp, declare it here and name it in
// command_line.cpp.

#include <functional>

#include "apps/exit_code.h"

namespace CLI {
class App;
}

namespace clerestory {

/// What the command line asked for; set by the command that was named, and run once all arguments are read.
using Task = std::function<ExitCode()>;

void add_solve_command(CLI::App& program, Task& task);
void add_check_command(CLI::App& program, Task& task);
void add_mesh_command(CLI::App& program, Task& task);
void add_bake_command(CLI::App& program, Task& task);
void add_formfactors_command(CLI::App& program, Task& task);
void add_tradeoff_command(CLI::App& program, Task& task);
void add_report_command(CLI::App& program, Task& task);
void add_mix_command(CLI::App& program, Task& task);
void add_annual_command(CLI::App& program, Task& task);
void add_merge_command(CLI::App& program, Task& task);
void add_render_command(CLI::App& program, Task& task);

}  // namespace clerestory
