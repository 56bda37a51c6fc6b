#include "apps/finish_report.h"

namespace clerestory {

void finish_report(RunReport& report, const CommonArguments& arguments, const Console& console, Outputs& outputs) {
  report.threads = arguments.threads;
  report.seconds.total = console.elapsed();
  report.peak_memory_bytes = peak_memory_bytes();
  report.warnings = console.warnings();
  if (!arguments.report.empty()) write_report(outputs.open(arguments.report), report);
}

}  // namespace clerestory
