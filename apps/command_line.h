#pragma once
// What the program was asked for.

#include <variant>

#include "apps/commands/commands.h"

namespace clerestory {

/// The task of the command that is named, not yet run. Nothing to run: help or the version was printed, or what is
/// wrong with the usage.
std::variant<Task, ExitCode> read_command_line(int argc, const char* const* argv);

}  // namespace clerestory
