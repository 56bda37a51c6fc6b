#pragma once
// Every command runs inside this: errors become one message and an exit code.

#include <functional>
#include <string>
#include <vector>

#include "apps/console.h"
#include "apps/exit_code.h"

namespace clerestory {

/// A file that a command reads or writes beside its input, --log and --report.
struct NamedFile {
  std::string option, file;  ///< "-o", "out.vtp"; the file is empty when it was not asked for
  bool is_written = true;
};

/// Refuses first of all that a file is written which is also read, or written twice.
ExitCode run(const CommonArguments& arguments, const std::string& input, std::vector<NamedFile> files,
             const std::function<ExitCode(Console&)>& work);

}  // namespace clerestory
