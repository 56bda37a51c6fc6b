#include "io/run_report.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "solver/model/version.h"

namespace clerestory {
namespace {

using Json = nlohmann::ordered_json;

long long count(std::size_t n) { return static_cast<long long>(n); }

void add_mesh_figures(std::vector<Figure>& out, const MeshReport& r) {
  const auto add = [&](const char* name, auto value) { out.push_back({std::string("repairs.") + name, value}); };
  add("input_faces", count(r.input_faces));
  add("input_triangles", count(r.input_triangles));
  add("welded_vertices", count(r.welded_vertices));
  add("non_finite_faces", count(r.non_finite_faces));
  add("degenerate_faces", count(r.degenerate_faces));
  add("duplicate_faces", count(r.duplicate_faces));
  add("opposite_faces", count(r.opposite_faces));
  add("overlapping_regions", count(r.overlapping_regions));
  add("t_junctions", count(r.t_junctions));
  add("imprinted_contacts", count(r.imprinted_contacts));
  add("imprinted_outlines", count(r.imprinted_outlines));
  add("simplified_parts", count(r.simplified_parts));
  add("simplified_faces", count(r.simplified_faces));
  add("simplified_by", r.simplified_by);
  add("non_manifold_edges", count(r.non_manifold_edges));
  add("boundary_edges", count(r.boundary_edges));
  add("planar_regions", count(r.planar_regions));
  add("max_element", r.max_element);
  add("longest_edge", r.longest_edge);
  add("shortest_edge", r.shortest_edge);
  add("worst_angle_deg", r.worst_angle_deg);
  add("median_angle_deg", r.median_angle_deg);
}

void add_error_figures(std::vector<Figure>& out, const std::string& group,
                       const std::optional<RunReport::Error>& error) {
  if (!error) return;
  out.push_back({group + ".rms_relative", error->rms_relative});
  out.push_back({group + ".median_relative", error->median_relative});
  out.push_back({group + ".p95_relative", error->p95_relative});
  out.push_back({group + ".samples", count(error->samples)});
  out.push_back({group + ".confidence", error->confidence});
  out.push_back({group + ".bound", error->bound});
  if (!error->reference.empty()) out.push_back({group + ".reference", error->reference});
}

void add_energy_figures(std::vector<Figure>& out, const EnergyBalance& energy) {
  out.insert(out.end(), {{"energy.emitted", energy.emitted},
                         {"energy.absorbed", energy.absorbed},
                         {"energy.escaped", energy.escaped},
                         {"energy.imbalance", energy.imbalance()}});
}

std::string two_digits(int n) { return (n < 10 ? "0" : "") + std::to_string(n); }

void add_daylight_figures(std::vector<Figure>& out, const Daylight& d) {
  if (d.weather) {
    out.push_back({"daylight.weather", d.weather->file});
    out.push_back({"daylight.date", two_digits(d.weather->month) + "-" + two_digits(d.weather->day)});
    out.push_back({"daylight.hour", static_cast<long long>(d.weather->hour)});
  }
  if (d.time) {
    const int minutes = static_cast<int>(std::lround(d.time->hour * 60));
    out.push_back({"daylight.sun_time", two_digits(minutes / 60) + ":" + two_digits(minutes % 60)});
  }
  out.push_back({"daylight.sun_elevation", d.sun.elevation_deg});
  out.push_back({"daylight.sun_azimuth", d.sun.azimuth_deg});
}

Json json_of(const RunReport::Luminaires& l) {
  Json json = {{"type", l.type}};
  if (!l.file.empty()) json["file"] = l.file;
  if (!l.group.empty()) json["group"] = l.group;
  json["count"] = l.count;
  json["luminous_flux"] = l.luminous_flux;
  if (l.type != "file") return json;
  json["file_flux"] = l.file_flux;
  if (l.declared_flux > 0) {
    json["declared_flux"] = l.declared_flux;
    json["flux_balance"] = l.file_flux / l.declared_flux;
  }
  if (l.lamp_flux > 0) {
    json["lamp_flux"] = l.lamp_flux;
    json["light_output_ratio"] = l.file_flux / l.lamp_flux;
  }
  return json;
}

Json json_of(const ShownLayer& l) {
  return {{"name", l.name},
          {"factor", l.factor},
          {"luminous_flux", l.luminous_flux()},
          {"emitted", l.energy.emitted},
          {"absorbed", l.energy.absorbed},
          {"escaped", l.energy.escaped}};
}

Json json_of(const SensorSummary& s) {
  Json json = {{"name", s.name},     {"kind", kSensorKindNames[static_cast<std::size_t>(s.kind)]},
               {"points", s.points}, {"mean", s.mean},
               {"min", s.min},       {"max", s.max},
               {"median", s.median}, {"uniformity", s.uniformity}};
  if (s.threshold) {
    json["threshold"] = s.threshold->lux;
    json["share_above_threshold"] = s.threshold->share;
  }
  if (s.daylight_factor)
    json["daylight_factor"] = {{"mean", s.daylight_factor->mean},
                               {"median", s.daylight_factor->median},
                               {"share_above_2", s.daylight_factor->share}};
  return json;
}

Json json_of(const RunReport::Space& s) {
  Json json = {{"name", s.name}};
  if (!s.long_name.empty()) json["long_name"] = s.long_name;
  if (s.volume > 0) json["area"] = s.area, json["height"] = s.height, json["volume"] = s.volume;
  return json;
}

Json json_of(const RunReport::PartError& p) {
  Json json = {{"name", p.name}, {"mean_illuminance", p.mean_illuminance}, {"samples", p.error.samples}};
  if (p.area > 0) json["area"] = p.area;
  // Where no path finds light there is no error to tell.
  const auto set = [&](const char* name, double value) { json[name] = p.error.samples > 0 ? Json(value) : Json(); };
  set("rms_relative", p.error.rms_relative);
  set("median_relative", p.error.median_relative);
  set("p95_relative", p.error.p95_relative);
  set("confidence", p.error.confidence);
  json["bound"] = p.error.bound;
  return json;
}

Json json_of(const LawInRoom& room) {
  return {{"name", room.room},
          {"worst", room.worst},
          {"bound", room.bound},
          {"resolved", room.resolved},
          {"holds", room.holds()}};
}

Json json_of(const LawCheck& check);

Json json_of(const NotRead& n) { return {{"what", n.what}, {"count", n.count}, {"first", n.first}}; }

Json json_of(const RunReport::AtTime& t);

template <class Row>
Json array_of(const std::vector<Row>& rows) {
  Json json = Json::array();
  for (const Row& row : rows) json.push_back(json_of(row));
  return json;
}

Json json_of(const LawCheck& check) {
  Json json = {{"law", kLawNames[static_cast<std::size_t>(check.law)]}};
  if (!check.not_checked.empty()) {
    json["not_checked"] = check.not_checked;
    return json;
  }
  json["holds"] = check.holds();
  if (const LawInRoom* worst = check.worst()) json["worst"] = json_of(*worst);
  json["spaces"] = array_of(check.rooms);
  return json;
}

std::vector<Figure> run_figures(const RunReport& r) {
  const auto& s = r.seconds;
  return {{"settings.threads", static_cast<long long>(r.threads)},
          {"seconds.read", s.read},
          {"seconds.mesh", s.mesh},
          {"seconds.build", s.build},
          {"seconds.direct", s.direct},
          {"seconds.refine", s.refine},
          {"seconds.gather", s.gather},
          {"seconds.reconstruct", s.reconstruct},
          {"seconds.measure", s.measure},
          {"seconds.write", s.write},
          {"seconds.total", s.total},
          {"peak_memory_bytes", count(r.peak_memory_bytes)}};
}

/// Sets the value at the place its dotted name says.
void set(Json& json, const Figure& figure) {
  Json* place = &json;
  std::size_t begin = 0;
  for (std::size_t dot; (dot = figure.name.find('.', begin)) != std::string::npos; begin = dot + 1)
    place = &(*place)[figure.name.substr(begin, dot - begin)];
  std::visit([&](const auto& value) { (*place)[figure.name.substr(begin)] = value; }, figure.value);
}

Json json_of(const RunReport::AtTime& t) {
  Json json = {{"time", t.time}, {"file", t.file}, {"mean_illuminance", t.mean_illuminance}};
  std::vector<Figure> figures;
  add_daylight_figures(figures, t.daylight);
  add_energy_figures(figures, t.energy);
  add_error_figures(figures, "error", t.error);
  add_error_figures(figures, "error_sensors", t.error_sensors);
  for (const Figure& figure : figures) set(json, figure);
  if (!t.error) json["error"] = nullptr;
  if (t.worst) json["error"]["worst"] = json_of(*t.worst);
  if (!t.sensors.empty()) json["sensors"] = array_of(t.sensors);
  return json;
}

}  // namespace

RunReport new_report(const std::string& input) {
  RunReport report;
  report.version = kVersion;
  report.input = input;
  return report;
}

std::vector<RunReport::Space> figures_of(const std::vector<NamedSpace>& spaces) {
  std::vector<RunReport::Space> figures;
  for (const NamedSpace& s : spaces) figures.push_back({s.name, s.long_name, floor_area(s), height(s), volume(s)});
  return figures;
}

std::string stop_name(StopReason stop) {
  switch (stop) {
    case StopReason::converged:
      return "converged";
    case StopReason::time_limit:
      return "time-limit";
    case StopReason::interrupted:
      return "interrupted";
    case StopReason::iteration_limit:
      return "iteration-limit";
  }
  return "unknown";
}

std::vector<Figure> repeatable_figures(const RunReport& r) {
  std::vector<Figure> out = {{"version", r.version}, {"input", r.input}, {"method", r.method}};
  if (!r.time.empty()) out.push_back({"time", r.time});
  for (const Figure& setting : r.settings) out.push_back({"settings." + setting.name, setting.value});
  const auto is_max_element = [](const Figure& setting) { return setting.name == "max_element"; };
  if (r.repairs.max_element > 0 && std::ranges::none_of(r.settings, is_max_element))
    out.push_back({"settings.max_element", r.repairs.max_element});  // not given: what the mesh chose
  const auto& c = r.counts;
  out.insert(out.end(), {{"counts.triangles", count(c.triangles)},
                         {"counts.elements", count(c.elements)},
                         {"counts.clusters", count(c.clusters)},
                         {"counts.openings", count(c.openings)},
                         {"counts.links", count(c.links)},
                         {"counts.rays", count(c.rays)},
                         {"counts.points", count(c.points)},
                         {"counts.sensors", count(c.sensors)},
                         {"counts.dark_sides", count(c.dark_sides)},
                         {"predicted_memory_bytes", count(r.predicted_memory_bytes)},
                         {"iterations", static_cast<long long>(r.iterations)},
                         {"residual", r.residual},
                         {"stop", stop_name(r.stop)}});
  add_energy_figures(out, r.energy);
  add_error_figures(out, "error", r.error);
  add_error_figures(out, "error_sensors", r.error_sensors);
  if (r.daylight) add_daylight_figures(out, *r.daylight);
  add_mesh_figures(out, r.repairs);
  return out;
}

namespace {

/// All but what only one run knows.
Json repeatable_json(const RunReport& report) {
  Json json;
  for (const Figure& figure : repeatable_figures(report)) set(json, figure);
  if (!report.error) json["error"] = nullptr;  // asked for by readers even when there was no time to measure
  if (report.error) json["error"]["spaces"] = array_of(report.error_spaces);
  if (report.error && report.worst_space) json["error"]["worst"] = json_of(report.error_spaces[*report.worst_space]);
  if (report.error_sensors) json["error_sensors"]["sets"] = array_of(report.error_sets);
  if (!report.luminaires.empty()) json["luminaires"] = array_of(report.luminaires);
  if (!report.layers.empty()) json["layers"] = array_of(report.layers);
  if (!report.sensors.empty()) json["sensors"] = array_of(report.sensors);
  if (!report.spaces.empty()) json["spaces"] = array_of(report.spaces);
  if (!report.not_read.empty()) json["not_read"] = array_of(report.not_read);
  if (!report.times.empty()) json["times"] = array_of(report.times);
  json["warnings"] = report.warnings;
  json["left_out"] = report.left_out;
  return json;
}

/// Names from models may hold bytes that are no UTF-8; they must not stop the report.
std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string repeatable_text(const RunReport& report) { return text_of(repeatable_json(report), -1); }

void write_report(AtomicFile& file, const RunReport& report) {
  Json json = repeatable_json(report);
  for (const Figure& figure : run_figures(report)) set(json, figure);
  if (!report.laws.empty()) json["laws"] = array_of(report.laws);
  json["log"] = report.log;
  file.write(text_of(json, 2) + "\n");
}

void write_report(const std::filesystem::path& file, const RunReport& report) {
  AtomicFile whole(file);
  write_report(whole, report);
  whole.commit();
}

}  // namespace clerestory
