#include "pipeline/annual/year_report.h"

#include <cmath>

#include "pipeline/wording.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

std::vector<AreaOfYear> told(const std::vector<YearArea>& areas) {
  std::vector<AreaOfYear> out;
  for (const YearArea& area : areas)
    out.push_back({area.name, area.points.size(), area.figures, area.closed, area.has_area});
  return out;
}

/// "62 %", or "62 % (58 to 66 %)" where the error of the illuminances leaves that open.
std::string words(const ShareWithin& share) {
  const auto figure = [](double x) { return rounded(std::round(10 * x) / 10, 3); };
  if (figure(share.low) == figure(share.high)) return figure(share.value) + " %";
  return figure(share.value) + " % (" + figure(share.low) + " to " + figure(share.high) + " %)";
}

std::string line_of(const AreaOfYear& area, const AnnualReport& report) {
  const AreaYear& year = area.year;
  std::string line = area.name + ": sDA " + rounded(report.threshold) + "/50 % " + words(year.sDA) +
                     ", ASE 1000,250 h " + words(year.ASE_more_than);
  if (year.ASE_at_least.value != year.ASE_more_than.value)
    line += " (" + words(year.ASE_at_least) + " with 250 h or more)";
  line += ", EN 17037 " + std::string(kEn17037LevelNames[static_cast<std::size_t>(year.level)]) + ", mean " +
          rounded(year.mean) + " lx";
  if (area.blinds.hours_closed > 0) line += ", blinds closed in " + std::to_string(area.blinds.hours_closed) + " h";
  if (area.blinds.hours_not_complying > 0)
    line += " and still too much sun in " + std::to_string(area.blinds.hours_not_complying) + " h";
  return line;
}

/// Which limits lie within the interval of an area: "an sDA of 55 % and an ASE of 10 %"; empty for none.
std::string open_limits(const AreaYear& year) {
  std::string open;
  const auto add = [&](const char* figure, const ShareWithin& share, double limit) {
    if (reaches_share(share.low, limit) != reaches_share(share.high, limit))
      open += (open.empty() ? "" : " and ") + ("an " + std::string(figure)) + " of " + rounded(limit) + " %";
  };
  for (const double limit : kLeedShares) add("sDA", year.sDA, limit);
  add("ASE", year.ASE_more_than, kLeedAse);
  return open;
}

}  // namespace

std::vector<std::string> warnings_of(const AnnualReport& report) {
  constexpr double kMuch = 0.2;  // of an illuminance: an interval that says little
  std::vector<std::string> warnings;
  const auto look_at = [&](const char* what, const std::vector<AreaOfYear>& areas, const YearError& error) {
    std::string dark;
    for (const AreaOfYear& area : areas) {
      if (const std::string open = open_limits(area.year); !open.empty())
        warnings.push_back(area.name + ": whether it has " + open +
                           " cannot be told at this accuracy; see its interval");
      if (!(area.year.mean > 0)) dark += (dark.empty() ? "" : ", ") + area.name;
    }
    if (!dark.empty()) warnings.push_back("no daylight arrives in " + dark);
    if (!areas.empty() && error.total > kMuch)
      warnings.push_back("illuminances of single hours in " + std::string(what) + " are only known to be within " +
                         percent(error.total) + "; use a finer --accuracy");
  };
  look_at("rooms", report.rooms, report.error_rooms);
  look_at("grids", report.grids, report.error_grids);
  if (report.rooms.empty() && report.grids.empty())
    warnings.push_back("there are no sensors, and no room with a floor was found: sDA, ASE and EN 17037 are of none");
  return warnings;
}

AnnualReport annual_report(const Scene& scene, const DaylightYear& year, const std::string& schedule,
                           const YearSolved& solved) {
  AnnualReport report;
  report.scene = scene.file, report.weather = year.file, report.city = year.city;
  report.latitude_deg = year.place.latitude_deg, report.longitude_deg = year.place.longitude_deg;
  report.timezone = year.place.timezone;
  report.schedule = schedule, report.occupied_hours = solved.rules.occupied_hours;
  report.lit_hours = static_cast<int>(year.hours.size()), report.missing_hours = year.missing_hours;
  report.threshold = solved.rules.threshold;
  report.blinds_operated = solved.has_blinds;
  report.error_rooms = solved.error_of_points, report.error_grids = solved.error_of_sensors;
  tell_areas(solved, report);
  return report;
}

void tell_areas(const YearSolved& solved, AnnualReport& report) {
  report.rooms = told(solved.rooms), report.grids = told(solved.grids);
}

void show_mean(const YearRules& rules, const std::vector<PointYear>& of_points, Solved& solved) {
  VertexLightmap& map = solved.lightmap;
  for (std::size_t p = 0; p < of_points.size(); ++p)
    map.E.set(p, Spectrum(of_points[p].lux_hours / rules.occupied_hours / kWhiteEfficacy));
  const PatchSet& patches = solved.patches;
  Solution& s = solved.solution;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    Spectrum mean(0.0);
    for (const std::uint32_t p : map.corners[i]) mean += map.E[p] / 3;
    s.E.set(i, mean);
  }
  for (std::size_t i = 0; i < patches.patch_count(); ++i) s.B.set(i, patches.scattered(s.E, i));
}

void add_figures(const YearSolved& solved, WrittenResult& result) {
  for (const YearFigure& figure : year_figures(solved.rules)) {
    WrittenArray& of_points = result.of_points[figure.name];
    for (const PointYear& p : solved.of_points) of_points.value.push_back(static_cast<float>(figure(p, solved.rules)));
    WrittenArray& of_cells = result.of_cells[figure.name];
    for (const auto& c : result.triangles)
      of_cells.value.push_back((of_points.value[c[0]] + of_points.value[c[1]] + of_points.value[c[2]]) / 3);
  }
}

std::vector<std::string> lines_of(const AnnualReport& report) {
  std::vector<std::string> lines;
  for (const auto* areas : {&report.rooms, &report.grids})
    for (const AreaOfYear& area : *areas) lines.push_back(line_of(area, report));
  return lines;
}

}  // namespace clerestory
