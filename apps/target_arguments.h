#pragma once
// --target LUX or NAME=LUX, as often as there are sensors.

#include <string>
#include <vector>

#include "pipeline/report/report_page.h"

namespace CLI {
class App;
}

namespace clerestory {

/// What is wrong with one, or nothing.
std::string problem_with_target(const std::string& target);

/// Of those that have no problem; of two for the same sensors the last counts.
ReportTargets report_targets(const std::vector<std::string>& targets);

void add_target_option(CLI::App& command, std::vector<std::string>& targets);

}  // namespace clerestory
