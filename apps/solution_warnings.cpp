#include "apps/solution_warnings.h"

#include "io/read_run_report.h"
#include "io/text.h"
#include "pipeline/wording.h"

namespace clerestory {

void repeat_warnings(const WrittenResult& result, Console& console) {
  constexpr std::size_t kShown = 3;  // the last ones are about the light
  const std::vector<std::string> warnings = run_report_of(result.report, result.file).warnings;
  const std::size_t first = warnings.size() > kShown ? warnings.size() - kShown : 0;
  for (std::size_t i = first; i < warnings.size(); ++i) console.warn("when it was solved: " + warnings[i]);
  if (first > 0)
    console.warn("when it was solved: " + counted(first, "more warning") + "; clerestory report shows all.");
}

}  // namespace clerestory
