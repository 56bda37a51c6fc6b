#pragma once
// What is told about a solve for several times: figures of each, and lines for people.

#include <span>
#include <string>
#include <vector>

#include "io/run_report.h"
#include "pipeline/solved.h"

namespace clerestory {

/// What a series' report says of one of its times.
///
/// report  of that time's own result.
RunReport::AtTime figures_at_time(const RunReport& report, const Solved& at_time, const std::string& file);

/// A table of the times, one line each below its header: where the sun stands, mean illuminance of surfaces and of each
/// set of sensors [lx], measured error.
std::vector<std::string> time_table(std::span<const RunReport::AtTime> times);

/// "2026-03-21T06:00 to 2026-03-21T20:00, 15 times"
std::string series_in_words(std::span<const SceneTime> times);

}  // namespace clerestory
