#pragma once
// The sections of a page. Each is HTML with a heading of its own, or nothing where the result has nothing of it.

#include <string>
#include <vector>

#include "io/run_report.h"
#include "pipeline/report/report_page.h"
#include "solver/evaluate/surface_figures.h"
#include "solver/model/sensors.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// "412", "1,234", "0.25": illuminance as a table shows it.
std::string lux_words(double lux);
/// "0.22": a uniformity.
std::string ratio_words(double ratio);
/// "12.5 m2" as "12.5".
std::string area_words(double square_metres);
/// "and 12 more"
std::string and_more(std::size_t n);

/// Of each set of sensors that has points, with the target that it is held against.
std::vector<SensorSummary> summaries_of(const WrittenResult& result, const ReportTargets& targets);

std::string view_section(const WrittenResult& result, const PageFiles& files);
std::string sensor_section(const WrittenResult& result, const std::vector<SensorSummary>& sets, std::size_t& plans);
std::string floor_section(const WrittenResult& result, std::size_t& plans);
std::string room_section(const WrittenResult& result, const std::vector<RoomFigures>& rooms, const RunReport& run);
std::string luminaire_section(const RunReport& run);
std::string daylight_section(const WrittenResult& result, const RunReport& run, const std::vector<SensorSummary>& sets);
std::string material_section(const WrittenResult& result);
std::string error_section(const RunReport& run);
std::string run_section(const WrittenResult& result, const RunReport& run);

}  // namespace clerestory
