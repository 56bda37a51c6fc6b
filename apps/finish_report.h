#pragma once
// The end of every report.

#include "apps/console.h"
#include "io/run_report.h"

namespace clerestory {

/// Adds what is known last: threads, time, memory, warnings; and makes the report one of the outputs where --report
/// asks for it.
void finish_report(RunReport& report, const CommonArguments& arguments, const Console& console, Outputs& outputs);

}  // namespace clerestory
