#include "apps/series_report.h"

#include <algorithm>

#include "apps/table_lines.h"
#include "io/moment.h"
#include "io/text.h"
#include "pipeline/wording.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr std::size_t kShownSets = 4;  ///< of sensors: more do not fit into a line

std::string error_words(const RunReport::Error& e) {
  return (e.bound ? "below " : "") + percent(e.rms_relative) + (e.bound ? "" : " (+- " + percent(e.confidence) + ")");
}

std::string error_of_surfaces(const RunReport::AtTime& t) {
  if (!(t.mean_illuminance > 0)) return "no light";
  return t.error ? error_words(*t.error) : "not measured";
}

}  // namespace

RunReport::AtTime figures_at_time(const RunReport& report, const Solved& at_time, const std::string& file) {
  double flux = 0;
  for (std::size_t i = 0; i < at_time.solution.E.size(); ++i)
    flux += photometric(at_time.solution.E[i]) * at_time.patches.area[i];
  RunReport::AtTime out;
  out.time = report.time, out.file = file;
  out.daylight = report.daylight.value_or(Daylight{});
  out.mean_illuminance = flux / at_time.patches.total_area();
  out.energy = report.energy;
  out.error = report.error, out.error_sensors = report.error_sensors;
  if (report.worst_space && report.error_spaces.size() > 1) out.worst = report.error_spaces[*report.worst_space];
  out.sensors = report.sensors;
  return out;
}

std::vector<std::string> time_table(std::span<const RunReport::AtTime> times) {
  const std::size_t sets = times.empty() ? 0 : std::min(times.front().sensors.size(), kShownSets);
  std::vector<std::vector<std::string>> rows = {{"lux by time", "sun up", "surfaces"}};
  for (std::size_t k = 0; k < sets; ++k) rows[0].push_back("'" + quotable(times.front().sensors[k].name, 20) + "'");
  const bool has_rooms = std::ranges::any_of(times, [](const RunReport::AtTime& t) { return t.worst.has_value(); });
  rows[0].push_back("error");
  if (has_rooms) rows[0].push_back("of the worst room");
  for (const RunReport::AtTime& t : times) {
    std::vector<std::string>& row = rows.emplace_back();
    row = {"  " + t.time, rounded(t.daylight.sun.elevation_deg) + " deg", rounded(t.mean_illuminance)};
    for (std::size_t k = 0; k < sets; ++k)
      row.push_back(k < t.sensors.size() ? rounded(t.sensors[k].mean) : std::string());
    row.push_back(error_of_surfaces(t));
    if (has_rooms) row.push_back(t.worst ? error_words(t.worst->error) : std::string());
  }
  return table_lines(rows);
}

std::string series_in_words(std::span<const SceneTime> times) {
  return text(moment_text(times.front().moment), " to ", moment_text(times.back().moment), ", ",
              counted(times.size(), "time"));
}

}  // namespace clerestory
