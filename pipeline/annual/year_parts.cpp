#include "pipeline/annual/year_parts.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "io/annual/year_part_tables.h"
#include "io/as_written.h"
#include "io/read_run_report.h"
#include "io/some_of.h"
#include "io/text.h"
#include "pipeline/annual/year_areas.h"
#include "pipeline/annual/year_report.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

std::vector<AreaPoints> points_of(const std::vector<YearArea>& areas) {
  std::vector<AreaPoints> all;
  for (const YearArea& area : areas) all.push_back({{area.points.begin(), area.points.end()}, area.weight});
  return all;
}

std::vector<YearArea> areas_of(const std::vector<AreaPoints>& points, const std::vector<AreaOfYear>& facts) {
  std::vector<YearArea> areas;
  for (std::size_t i = 0; i < points.size(); ++i) {
    YearArea& area = areas.emplace_back();
    area.name = facts[i].name, area.closed = facts[i].blinds, area.has_area = facts[i].has_area;
    area.points.assign(points[i].points.begin(), points[i].points.end());
    area.weight = points[i].weight;
  }
  return areas;
}

/// Elements and points as far as the light that leaves them, and a result, need them.
void restore_surfaces(const WrittenResult& result, const YearPart& part, Solved& solved) {
  PatchSet& patches = solved.patches;
  VertexLightmap& map = solved.lightmap;
  const std::size_t N = result.triangles.size();
  map.position = part.position;
  map.corners = result.triangles;
  map.patch_of_point = part.patch_of_point;
  map.E = Field(part.position.size(), part.rho.channels);
  patches.origin = part.origin;
  patches.channels = part.rho.channels;
  patches.vertices = part.position;
  for (std::size_t i = 0; i < N; ++i) {
    const auto& [a, b, c] = result.triangles[i];
    patches.corners.push_back({VertexId{std::size_t{a}}, VertexId{std::size_t{b}}, VertexId{std::size_t{c}}});
    const MaterialId material{std::size_t{result.material[i]}};
    const SurfaceId surface{std::size_t{result.surface[i]}};
    patches.side_material.push_back({material, material});
    patches.side_surface.push_back({surface, surface});
    patches.triangle.push_back(TriangleId{i});
    patches.side.push_back(kFront);
    patches.area.push_back(result.of_cells.at("area").value[i]);
    patches.level.push_back(static_cast<std::uint8_t>(std::clamp(result.of_cells.at("level").value[i], 0.0f, 255.0f)));
  }
  patches.rho = part.rho, patches.tau = part.tau;
  patches.M = Field(N, patches.channels);  // by daylight alone
  patches.behind_begin = part.behind_begin;
  for (std::size_t i = 0; i < part.behind_patch.size(); ++i)
    patches.behind.push_back({PatchId{std::size_t{part.behind_patch[i]}}, part.behind_share[i]});
  patches.materials = result.materials;
  patches.surfaces = result.surfaces;
  patches.rooms = result.rooms;
  patches.room = result.room;
  solved.solution.E = solved.solution.B = Field(N, patches.channels);
}

std::string value_of(const Figure& figure) {
  return std::visit([](const auto& value) { return text(value); }, figure.value);
}

/// What differs in the files that were read; nothing where none does.
std::string difference(const std::vector<FileOfRun>& a, const std::vector<FileOfRun>& b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (a[i].name != b[i].name) return "the one read " + a[i].name + ", the other " + b[i].name;
    if (a[i].digest != b[i].digest) return "the contents of " + a[i].name + " differ";
  }
  return a.size() != b.size() ? "they read another number of files" : "";
}

/// The same of settings and results, but for the name that the input was called by: "./a.json" is "a.json".
std::string difference(const RunReport& a, const RunReport& b) {
  const std::vector<Figure> as = repeatable_figures(a), bs = repeatable_figures(b);
  for (std::size_t i = 0; i < std::min(as.size(), bs.size()); ++i) {
    if (as[i].name == "input" && bs[i].name == "input") continue;
    if (as[i].name != bs[i].name) return "the one has " + as[i].name + ", the other " + bs[i].name;
    if (value_of(as[i]) != value_of(bs[i])) return as[i].name + " is " + value_of(as[i]) + " and " + value_of(bs[i]);
  }
  return "";
}

/// The report without the name of the input, and warnings, which begin with it.
std::string nameless(RunReport report) {
  report.input.clear(), report.warnings.clear();
  return repeatable_text(report);
}

/// The same of all else. Computers of different kinds may differ in the last digit of a number.
bool is_same_mesh(const WrittenResult& a, const WrittenResult& b) {
  const auto same_tables = std::ranges::all_of(a.year_tables, [&](const auto& named) {
    const auto other = b.year_tables.find(named.first);
    return is_of_one_part(named.first) || (other != b.year_tables.end() && other->second.value == named.second.value);
  });
  return same_tables && a.triangles == b.triangles && a.material == b.material && a.surface == b.surface &&
         a.year_part == b.year_part;
}

YearSolved::Range put(const std::vector<PointYear>& from, std::size_t at, std::vector<PointYear>& to) {
  std::ranges::copy(from, to.begin() + static_cast<std::ptrdiff_t>(at));
  return {at, at + from.size()};
}

}  // namespace

YearPart part_of_year(const YearSolved& solved, const YearSettings& settings, const AnnualReport& facts,
                      std::vector<SensorPoint> sensors, std::vector<FileOfRun> files) {
  const PatchSet& patches = solved.solved.patches;
  const VertexLightmap& map = solved.solved.lightmap;
  YearPart part;
  part.part = settings.part, part.parts = settings.parts;
  part.facts = facts;
  part.more_thresholds = settings.more_thresholds;
  part.files = std::move(files);
  part.rooms = points_of(solved.rooms), part.grids = points_of(solved.grids);
  part.sensors = std::move(sensors);
  part.origin = patches.origin;
  part.position = map.position;
  part.patch_of_point = map.patch_of_point;
  part.rho = patches.rho, part.tau = patches.tau;
  part.behind_begin = patches.behind_begin;
  for (const PatchSet::Behind& behind : patches.behind) {
    part.behind_patch.push_back(static_cast<std::uint32_t>(behind.patch.value));
    part.behind_share.push_back(behind.share);
  }
  const auto cut = [](const std::vector<PointYear>& all, const YearSolved::Range& range) {
    return std::vector<PointYear>(all.begin() + static_cast<std::ptrdiff_t>(range.begin),
                                  all.begin() + static_cast<std::ptrdiff_t>(range.end));
  };
  part.first_point = solved.part_of_points.begin, part.first_sensor = solved.part_of_sensors.begin;
  part.of_points = cut(solved.of_points, solved.part_of_points);
  part.of_sensors = cut(solved.of_sensors, solved.part_of_sensors);
  return part;
}

void mark_other_parts(const YearPart& part, WrittenResult& result) {
  const float not_there = -1;
  const auto is_there = [&](std::size_t point) {
    return point >= part.first_point && point < part.first_point + part.of_points.size();
  };
  const auto mark = [&](WrittenArray& array, std::size_t row) {
    const auto n = static_cast<std::size_t>(array.components);
    std::fill_n(array.value.begin() + static_cast<std::ptrdiff_t>(row * n), n, not_there);
  };
  for (auto& [name, array] : result.of_points)
    for (std::size_t p = 0; p < result.points.size(); ++p)
      if (!is_there(p)) mark(array, p);
  for (auto& [name, array] : result.of_cells)
    for (std::size_t i = 0; i < result.triangles.size() && name != "area" && name != "level"; ++i)
      if (!std::ranges::all_of(result.triangles[i], is_there)) mark(array, i);
}

void YearMerge::require_same_run(const WrittenResult& result, const YearPart& part) const {
  const RunReport here = run_report_of(first_.report, first_.file), there = run_report_of(result.report, result.file);
  std::string what = here.version != there.version
                         ? "Clerestory " + here.version + " wrote the one, " + there.version + " the other"
                         : difference(facts_.files, part.files);
  if (what.empty()) what = difference(here, there);
  if (what.empty() && facts_.more_thresholds != part.more_thresholds) what = "they have other --threshold";
  if (what.empty() && facts_.parts != part.parts)
    what = text("the one is of ", facts_.parts, " parts, the other of ", part.parts);
  if (what.empty() && !is_same_mesh(first_, result)) what = "their elements, rooms or sensors differ";
  if (what.empty() && nameless(here) != nameless(there)) what = "what their reports tell differs";
  if (!what.empty())
    throw InputError(text(first_.file, " and ", result.file, ": are parts of different runs: ", what,
                          "; run all parts with the same files and options, on computers of one kind."));
}

void YearMerge::add(WrittenResult result) {
  const YearPart part = year_part_of(result);
  const std::string file = result.file;
  if (parts_.empty()) {
    if (result.of_cells.find("area") == result.of_cells.end() || result.of_cells.find("level") == result.of_cells.end())
      throw InputError(result.file + ": has no arrays 'area' and 'level' on its cells; run this part again.");
    first_ = std::move(result);
    facts_ = part;
    parts_.resize(part.parts);
    of_points_.resize(first_.points.size());
    of_sensors_.resize(part.sensors.size());
  } else {
    require_same_run(result, part);
    if (const std::string& other = parts_[part.part - 1].file; !other.empty())
      throw InputError(
          text(other, " and ", file, ": are both part ", part.part, " of ", part.parts, "; give each part once."));
  }
  parts_[part.part - 1] = {file, put(part.of_points, part.first_point, of_points_),
                           put(part.of_sensors, part.first_sensor, of_sensors_)};
}

MergedYear YearMerge::finish() {
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < parts_.size(); ++i)
    if (parts_[i].file.empty()) missing.push_back(i + 1);
  if (!missing.empty())
    throw InputError(text(first_.file, ": is part ", facts_.part, " of ", facts_.parts, ", and there ",
                          missing.size() == 1 ? "is no part " : "are no parts ", some_of(missing, 20, std::identity()),
                          "; run them by --part i/", facts_.parts, ", or name their files, too."));
  std::size_t points = 0, sensors = 0;  // where the next part has to begin
  for (const Part& part : parts_) {
    if (part.points.begin != points || part.sensors.begin != sensors)
      throw InputError(part.file + ": does not begin where the part before it ends; run this part again.");
    points = part.points.end, sensors = part.sensors.end;
  }
  if (points != of_points_.size() || sensors != of_sensors_.size())
    throw InputError(parts_.back().file + ": ends before the last point; run this part again.");
  MergedYear merged;
  YearSolved& year = merged.solved;
  year.rules.occupied_hours = facts_.facts.occupied_hours;
  year.rules.threshold = facts_.facts.threshold;
  year.rules.more_thresholds = facts_.more_thresholds;
  year.has_blinds = facts_.facts.blinds_operated;
  year.of_points = std::move(of_points_), year.of_sensors = std::move(of_sensors_);
  year.rooms = areas_of(facts_.rooms, facts_.facts.rooms), year.grids = areas_of(facts_.grids, facts_.facts.grids);
  add_up(year);
  restore_surfaces(first_, facts_, year.solved);
  show_mean(year.rules, year.of_points, year.solved);
  merged.result = as_written(year.solved.patches, year.solved.lightmap, year.solved.solution, first_.around, {});
  add_figures(year, merged.result);
  merged.annual = facts_.facts;
  tell_areas(year, merged.annual);
  merged.report = run_report_of(first_.report, first_.file);
  merged.annual.scene = merged.report.input;
  merged.sensors = facts_.sensors;
  return merged;
}

}  // namespace clerestory
