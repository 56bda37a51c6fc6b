#pragma once
// Every command runs inside this: errors become one message and an exit code.

#include <functional>
#include <string>
#include <vector>

#include "apps/console.h"
#include "apps/exit_code.h"

namespace clerestory {

/// What a limit of the system on memory is answered with, and kInputRefused.
inline constexpr const char* kOutOfMemory =
    "out of memory: not enough for this model at this fineness. Allow more (ulimit -v), or try a larger --max-element, "
    "or --accuracy draft.";

/// What an internal failure ends with.
inline constexpr const char* kPleaseReport = "; this is a mistake of the program, please report it.";

/// files  that the command reads or writes beside its input, --log and --report.
ExitCode run(const CommonArguments& arguments, const std::string& input, std::vector<NamedFile> files,
             const std::function<ExitCode(Console&)>& work);

}  // namespace clerestory
