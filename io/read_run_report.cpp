#include "io/read_run_report.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "io/parse_json.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

using Json = nlohmann::ordered_json;

/// Where a member is; null where it is missing or null.
const Json* find(const Json& json, const char* name) {
  if (!json.is_object()) return &json.at(name);  // throws, and says what it is
  const auto at = json.find(name);
  return at == json.end() || at->is_null() ? nullptr : &*at;
}

/// A member, or what stands for one that is missing.
template <class Value>
Value get(const Json& json, const char* name, Value otherwise = {}) {
  const Json* at = find(json, name);
  return at ? at->get<Value>() : otherwise;
}

const Json& member(const Json& json, const char* name) {
  static const Json kNone = Json::object();
  const Json* at = find(json, name);
  return at ? *at : kNone;
}

template <class Row, class Read>
std::vector<Row> rows_of(const Json& json, const char* name, const Read& read) {
  std::vector<Row> rows;
  for (const Json& row : member(json, name)) rows.push_back(read(row));
  return rows;
}

RunReport::Error error_of(const Json& json) {
  return {get<double>(json, "rms_relative"),  get<double>(json, "median_relative"), get<double>(json, "p95_relative"),
          get<std::size_t>(json, "samples"),  get<double>(json, "confidence"),      get<bool>(json, "bound"),
          get<std::string>(json, "reference")};
}

RunReport::PartError part_error_of(const Json& json) {
  return {get<std::string>(json, "name"), get<double>(json, "area"), get<double>(json, "mean_illuminance"),
          error_of(json)};
}

RunReport::Luminaires luminaires_of(const Json& json) {
  return {get<std::string>(json, "type"),     get<std::string>(json, "file"),     get<std::string>(json, "group"),
          get<std::size_t>(json, "count"),    get<double>(json, "luminous_flux"), get<double>(json, "file_flux"),
          get<double>(json, "declared_flux"), get<double>(json, "lamp_flux")};
}

Figure figure_of(const std::string& name, const Json& value) {
  if (value.is_boolean()) return {name, value.get<bool>()};
  if (value.is_number_integer()) return {name, value.get<long long>()};
  if (value.is_number()) return {name, value.get<double>()};
  return {name, value.get<std::string>()};
}

Daylight daylight_of(const Json& json) {
  Daylight daylight;
  daylight.sun.elevation_deg = get<double>(json, "sun_elevation");
  daylight.sun.azimuth_deg = get<double>(json, "sun_azimuth");
  int a = 0, b = 0;
  if (const auto time = get<std::string>(json, "sun_time"); std::sscanf(time.c_str(), "%d:%d", &a, &b) == 2)
    daylight.time.emplace().hour = a + b / 60.0;
  if (json.contains("weather")) {
    const auto date = get<std::string>(json, "date");
    if (std::sscanf(date.c_str(), "%d-%d", &a, &b) != 2) a = b = 0;
    daylight.weather = {get<std::string>(json, "weather"), a, b, get<int>(json, "hour")};
  }
  return daylight;
}

MeshReport repairs_of(const Json& json) {
  MeshReport r;
  const std::pair<const char*, std::size_t*> counts[] = {{"input_faces", &r.input_faces},
                                                         {"input_triangles", &r.input_triangles},
                                                         {"welded_vertices", &r.welded_vertices},
                                                         {"non_finite_faces", &r.non_finite_faces},
                                                         {"degenerate_faces", &r.degenerate_faces},
                                                         {"duplicate_faces", &r.duplicate_faces},
                                                         {"opposite_faces", &r.opposite_faces},
                                                         {"overlapping_regions", &r.overlapping_regions},
                                                         {"t_junctions", &r.t_junctions},
                                                         {"imprinted_contacts", &r.imprinted_contacts},
                                                         {"imprinted_outlines", &r.imprinted_outlines},
                                                         {"simplified_parts", &r.simplified_parts},
                                                         {"simplified_faces", &r.simplified_faces},
                                                         {"non_manifold_edges", &r.non_manifold_edges},
                                                         {"boundary_edges", &r.boundary_edges},
                                                         {"planar_regions", &r.planar_regions}};
  for (const auto& [name, count] : counts) *count = get<std::size_t>(json, name);
  const std::pair<const char*, double*> lengths[] = {
      {"simplified_by", &r.simplified_by},     {"max_element", &r.max_element},
      {"longest_edge", &r.longest_edge},       {"shortest_edge", &r.shortest_edge},
      {"worst_angle_deg", &r.worst_angle_deg}, {"median_angle_deg", &r.median_angle_deg}};
  for (const auto& [name, length] : lengths) *length = get<double>(json, name);
  return r;
}

StopReason stop_of(const std::string& name) {
  for (const StopReason stop : {StopReason::time_limit, StopReason::interrupted, StopReason::iteration_limit})
    if (stop_name(stop) == name) return stop;
  return StopReason::converged;
}

RunReport report_of(const Json& json) {
  RunReport r;
  r.version = get<std::string>(json, "version");
  r.input = get<std::string>(json, "input");
  r.method = get<std::string>(json, "method");
  r.time = get<std::string>(json, "time");
  for (const auto& [name, value] : member(json, "settings").items()) r.settings.push_back(figure_of(name, value));
  const Json& counts = member(json, "counts");
  r.counts.triangles = get<std::size_t>(counts, "triangles");
  r.counts.elements = get<std::size_t>(counts, "elements");
  r.counts.dark_sides = get<std::size_t>(counts, "dark_sides");
  r.counts.clusters = get<std::size_t>(counts, "clusters");
  r.counts.openings = get<std::size_t>(counts, "openings");
  r.counts.points = get<std::size_t>(counts, "points");
  r.counts.links = get<std::size_t>(counts, "links");
  r.counts.sensors = get<std::size_t>(counts, "sensors");
  r.counts.rays = get<unsigned long long>(counts, "rays");
  r.predicted_memory_bytes = get<std::size_t>(json, "predicted_memory_bytes");
  r.iterations = get<long>(json, "iterations");
  r.residual = get<double>(json, "residual");
  r.stop = stop_of(get<std::string>(json, "stop"));
  const Json& energy = member(json, "energy");
  r.energy.emitted = get<double>(energy, "emitted");
  r.energy.absorbed = get<double>(energy, "absorbed");
  r.energy.escaped = get<double>(energy, "escaped");
  if (const Json& error = member(json, "error"); !error.empty()) {
    r.error = error_of(error);
    r.error_spaces = rows_of<RunReport::PartError>(error, "spaces", part_error_of);
    const std::string worst = get<std::string>(member(error, "worst"), "name");
    for (std::size_t i = 0; i < r.error_spaces.size(); ++i)
      if (r.error_spaces[i].name == worst) r.worst_space = i;
  }
  if (const Json& error = member(json, "error_sensors"); !error.empty()) {
    r.error_sensors = error_of(error);
    r.error_sets = rows_of<RunReport::PartError>(error, "sets", part_error_of);
  }
  if (const Json& daylight = member(json, "daylight"); !daylight.empty()) r.daylight = daylight_of(daylight);
  r.luminaires = rows_of<RunReport::Luminaires>(json, "luminaires", luminaires_of);
  r.layers = rows_of<ShownLayer>(json, "layers", [](const Json& l) -> ShownLayer {
    return {get<std::string>(l, "name"),
            {get<double>(l, "emitted"), get<double>(l, "absorbed"), get<double>(l, "escaped")},
            {},
            get<double>(l, "factor", 1)};
  });
  r.spaces = rows_of<RunReport::Space>(json, "spaces", [](const Json& s) -> RunReport::Space {
    return {get<std::string>(s, "name"), get<std::string>(s, "long_name"), get<double>(s, "area"),
            get<double>(s, "height"), get<double>(s, "volume")};
  });
  r.not_read = rows_of<NotRead>(json, "not_read", [](const Json& n) -> NotRead {
    return {get<std::string>(n, "what"), get<std::size_t>(n, "count"), get<std::string>(n, "first")};
  });
  r.repairs = repairs_of(member(json, "repairs"));
  r.warnings = get<std::vector<std::string>>(json, "warnings");
  r.left_out = get<std::vector<std::string>>(json, "left_out");
  return r;
}

}  // namespace

RunReport run_report_of(const std::string& json, const std::string& file) {
  if (json.empty()) return {};
  try {
    return report_of(parse_json<Json>(json, file, {.deepest = 32, .most_keys = 100'000}));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(
        text(file, ": the report in it is damaged (", quotable(error.what(), 100), "); solve the scene again."));
  }
}

}  // namespace clerestory
