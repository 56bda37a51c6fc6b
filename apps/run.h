#pragma once
// Every command runs inside this: errors become one message and an exit code.

#include <functional>

#include "apps/console.h"
#include "apps/exit_code.h"

namespace clerestory {

ExitCode run(const CommonArguments& arguments, const std::string& input, const std::function<ExitCode(Console&)>& work);

}  // namespace clerestory
