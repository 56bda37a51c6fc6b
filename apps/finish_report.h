#pragma once
// The end of every report.

#include "apps/console.h"
#include "io/run_report.h"

namespace clerestory {

/// Adds what is known last: threads, time, memory, warnings; and writes the report where --report asks for one.
void finish_report(RunReport& report, const CommonArguments& arguments, const Console& console);

}  // namespace clerestory
