#pragma once
// A result as one page for people who do not run the program: figures, plans, a 3D view.

#include <map>
#include <optional>
#include <string>

#include "io/page/page_files.h"
#include "io/run_report.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// Illuminance that sensors should have [lx].
struct ReportTargets {
  std::optional<double> of_all;               ///< empty: the threshold that each set carries, if any
  std::map<std::string, double> of_set = {};  ///< by name, before the others
};

/// throws  InputError that names the sets there are when a target is of another.
void require_known_sets(const ReportTargets& targets, const WrittenResult& result);

/// HTML that is whole in itself: no other file and no network. Equal results make equal bytes.
std::string report_page(const WrittenResult& result, const RunReport& run, const PageFiles& files,
                        const ReportTargets& targets);

}  // namespace clerestory
