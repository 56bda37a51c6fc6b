#include "io/scene_file/sensor_entries.h"

#include <algorithm>
#include <cmath>

#include "io/formats/add_mesh.h"
#include "io/input_file.h"
#include "io/read_sensors.h"
#include "io/scene_file/material_rules.h"
#include "io/some_of.h"
#include "io/text.h"
#include "io/unit_vector.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

/// Steps of `spacing` that fit into `length`; a length that is a whole multiple in decimal counts as one.
double steps(double length, double spacing) { return std::floor(length / spacing * (1 + 1e-9) + 1e-9); }

constexpr Vec3 kUp{0, 0, 1};

void refuse_beside(const JsonObject& object, std::initializer_list<std::string_view> keys, std::string_view other) {
  for (const std::string_view key : keys)
    if (object.has(key)) throw InputError(text(object.place(key), " does not go with ", other));
}

SensorKind read_kind(const JsonObject& object) {
  const auto name = object.choice("kind", kSensorKindNames);
  if (!name) return SensorKind::planar;
  return SensorKind(std::ranges::find(kSensorKindNames, *name) - std::begin(kSensorKindNames));
}

/// Normal of a grid's points; of a cylinder the axis.
Vec3 grid_normal(const JsonObject& object, SensorKind kind, const Vec3& u, const Vec3& v) {
  if (kind == SensorKind::horizontal)
    refuse_beside(object, {"normal"}, "\"kind\": \"horizontal\", which faces up; leave it out");
  if (kind == SensorKind::camera)
    refuse_beside(object, {"normal"}, "\"kind\": \"camera\", which faces the camera; leave it out");
  if (const auto normal = object.unit_vector("normal")) return *normal;
  if (kind == SensorKind::planar || kind == SensorKind::vertical) {
    const Vec3 across = normalized(cross(normalized(u), normalized(v)));
    if (length(across) > 0) return across;
    throw InputError(text(object.place("normal"), " is missing, and u and v span no plane to take it from"));
  }
  return kUp;  // the others have their own
}

std::string limit(SensorKind kind) {
  return text("at most ", kMaxSensors, " in one scene",
              kind == SensorKind::cylindrical ? text(", and each cylindrical one counts as ", kCylinderPlanes) : "");
}

SensorSet read_grid(const JsonObject& object, SensorKind kind, std::size_t room_left) {
  for (const std::string_view key : {"origin", "u", "v", "spacing"}) object.at(key);
  const Vec3 origin = *object.vector("origin", kCoordinate), u = *object.vector("u", kCoordinate),
             v = *object.vector("v", kCoordinate);
  const double spacing =
      *object.number("spacing", {.low = 0, .high = 1e12, .low_allowed = false, .advice = "it is in metres"});
  const Vec3 normal = grid_normal(object, kind, u, v);
  const double along_u = steps(length(u), spacing) + 1, along_v = steps(length(v), spacing) + 1;
  if (!(along_u * along_v <= static_cast<double>(room_left))) {
    throw InputError(
        text(object.place("spacing"), " = ", spacing, " makes ", along_u, " x ", along_v, " points; ", limit(kind)));
  }
  SensorSet sensors;
  const Vec3 step_u = normalized(u) * spacing, step_v = normalized(v) * spacing;
  for (int j = 0; j < static_cast<int>(along_v); ++j) {
    for (int i = 0; i < static_cast<int>(along_u); ++i) {
      const Vec3 p = origin + step_u * i + step_v * j;
      if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kCoordinate.high)) {
        throw InputError(text(object.where(), ": origin, u and v lead to a point at (", p.x, ", ", p.y, ", ", p.z,
                              "), outside [-1e12, 1e12] m"));
      }
      sensors.points.push_back({p, normal});
    }
  }
  sensors.area_of_point = spacing * spacing;
  return sensors;
}

std::string place_of(const SensorSet& set, std::size_t i) {
  const Vec3& p = set.points[i].position;
  return text("point ", i + 1, " at (", p.x, ", ", p.y, ", ", p.z, ")");
}

/// Normals as the kind wants them, whatever a file says.
void orient(const JsonObject& object, SensorSet& set) {
  if (set.kind == SensorKind::horizontal)
    for (SensorPoint& point : set.points) point.normal = kUp;
  if (set.kind == SensorKind::vertical) {
    for (std::size_t i = 0; i < set.points.size(); ++i) {
      const Vec3& n = set.points[i].normal;
      if (std::abs(n.z) <= 1e-6) continue;
      throw InputError(text(object.where(), ": ", place_of(set, i), " has the normal (", n.x, ", ", n.y, ", ", n.z,
                            "); \"kind\": \"vertical\" needs a horizontal one, [0, -1, 0] for who looks to -y"));
    }
  }
  if (set.kind == SensorKind::camera) {
    object.at("camera");
    const Vec3 camera = *object.vector("camera", kCoordinate);
    for (std::size_t i = 0; i < set.points.size(); ++i) {
      const Vec3 to_camera = camera - set.points[i].position;
      if (!(length(to_camera) > 1e-6))  // what rounding leaves of a grid point has a direction, and no meaning
        throw InputError(text(object.place("camera"), " is where ", place_of(set, i),
                              " is, and a point cannot face itself; move one of them"));
      set.points[i].normal = unit_vector(to_camera);
    }
  } else {
    refuse_beside(
        object, {"camera"},
        text("\"kind\": \"", kSensorKindNames[static_cast<std::size_t>(set.kind)], "\"; write \"kind\": \"camera\""));
  }
}

constexpr double kWorkPlane = 0.8;  // [m] above the floor

/// Points of a grid in one space.
SensorSet grid_in(const NamedSpace& space, const JsonObject& object, SensorKind kind, std::size_t room_left) {
  const double height = object.number("height", {.low = 0, .high = 1e6, .advice = "it is in metres above the floor"})
                            .value_or(kWorkPlane);
  object.at("spacing");
  const double spacing =
      *object.number("spacing", {.low = 0, .high = 1e12, .low_allowed = false, .advice = "it is in metres"});
  const Vec3 u = wall_direction(space), v = cross(kUp, u);
  const Vec3 normal = grid_normal(object, kind, u, v);
  double lower[2] = {1e300, 1e300}, upper[2] = {-1e300, -1e300};
  for (const std::uint32_t c : space.corner) {
    const Vec3& p = space.vertices[c];
    const double along[2] = {dot(p, u), dot(p, v)};
    for (int k = 0; k < 2; ++k) lower[k] = std::min(lower[k], along[k]), upper[k] = std::max(upper[k], along[k]);
  }
  const double cells[2] = {std::max(std::ceil((upper[0] - lower[0]) / spacing - 1e-9), 1.0),
                           std::max(std::ceil((upper[1] - lower[1]) / spacing - 1e-9), 1.0)};
  if (!(cells[0] * cells[1] <= static_cast<double>(room_left)))
    throw InputError(text(object.place("spacing"), " = ", spacing, " makes ", cells[0], " x ", cells[1], " points in '",
                          quotable(space.name), "'; ", limit(kind)));
  const double first[2] = {(lower[0] + upper[0] - (cells[0] - 1) * spacing) / 2,
                           (lower[1] + upper[1] - (cells[1] - 1) * spacing) / 2};
  SensorSet sensors;
  for (int j = 0; j < static_cast<int>(cells[1]); ++j)
    for (int i = 0; i < static_cast<int>(cells[0]); ++i) {
      const Vec3 p = u * (first[0] + i * spacing) + v * (first[1] + j * spacing);
      const std::vector<SpaceSpan> spans = spans_at(space, p.x, p.y);
      if (spans.empty() || !(spans[0].floor + height < spans[0].ceiling)) continue;
      sensors.points.push_back({{p.x, p.y, spans[0].floor + height}, normal});
    }
  sensors.area_of_point = spacing * spacing;
  return sensors;
}

std::string names_of(const std::vector<NamedSpace>& spaces) {
  return some_of(spaces, 6, [](const NamedSpace& space) { return "'" + quotable(space.name) + "'"; });
}

bool is_named(const NamedSpace& space, const std::string& pattern) {
  return matches(pattern, space.name) || matches(pattern, space.long_name) ||
         matches(pattern, space.name + " " + space.long_name);
}

std::vector<SensorSet> sets_in_spaces(const SpaceGrid& grid, const std::vector<NamedSpace>& spaces, std::size_t total) {
  const std::string place = grid.object.place("space"), named = text(place, " '", quotable(grid.pattern), "'");
  if (spaces.empty()) throw InputError(text(named, ": no model has spaces; give origin, u and v instead"));
  const std::string set_name = grid.object.word("name").value_or("");
  const std::size_t weight = planes_a_sensor(grid.kind);
  std::vector<SensorSet> sets;
  bool any = false;
  for (const NamedSpace& space : spaces) {
    if (!is_named(space, grid.pattern)) continue;
    any = true;
    if (!space.has_volume()) continue;
    SensorSet set = grid_in(space, grid.object, grid.kind, (kMaxSensors - total) / weight);
    if (set.points.empty()) continue;
    total += set.points.size() * weight;
    set.name = set_name.empty() ? space.name : set_name + " " + space.name;
    set.kind = grid.kind;
    set.threshold = grid.threshold;
    orient(grid.object, set);
    sets.push_back(std::move(set));
  }
  if (!any) throw InputError(text(named, " matches no space; the models have ", names_of(spaces)));
  if (sets.empty())
    throw InputError(text(named, ": no point of the grid is inside; check height and spacing, and whether the spaces ",
                          "have a volume"));
  return sets;
}

}  // namespace

SensorEntries read_sensor_entries(const Json& sensors, const std::string& file_name,
                                  const std::filesystem::path& folder) {
  SensorEntries entries;
  std::vector<SensorSet>& sets = entries.sets;
  std::size_t total = 0, n = 0;
  for (const Json& entry : as_array(sensors, file_name + ": sensors", "sensor sets")) {
    const JsonObject object(
        entry, text(file_name, ": sensors[", n++, "]"),
        {"name", "file", "origin", "u", "v", "spacing", "normal", "kind", "camera", "threshold", "space", "height"});
    const SensorKind kind = read_kind(object);
    const std::size_t weight = planes_a_sensor(kind);
    const auto threshold =
        object.number("threshold", {.low = 0, .high = kMostLight, .low_allowed = false, .advice = "it is in lux"});
    if (object.has("space")) {
      refuse_beside(object, {"file", "origin", "u", "v"}, "\"space\"; keep one of them");
      object.at("spacing");
      entries.grids.push_back({sets.size(), object, *object.word("space"), kind, threshold});
      continue;
    }
    refuse_beside(object, {"height"}, "a grid that names no \"space\"");
    if (object.has("file")) {
      refuse_beside(object, {"origin", "u", "v", "spacing", "normal"}, "\"file\"; keep one of them");
      const std::string file = *object.word("file");
      require_file(folder / file, object.place("file"), file);
      sets.push_back(read_sensors(folder / file));
    } else {
      sets.push_back(read_grid(object, kind, (kMaxSensors - total) / weight));
    }
    SensorSet& set = sets.back();
    set.kind = kind;
    set.threshold = threshold;
    if (const auto name = object.word("name")) set.name = *name;
    if (set.name.empty()) set.name = text("sensors ", n);
    orient(object, set);
    total += set.points.size() * weight;
    if (total > kMaxSensors) throw InputError(text(object.where(), ": too many points; ", limit(kind)));
  }
  return entries;
}

std::vector<SensorSet> sets_of(SensorEntries entries, const std::vector<NamedSpace>& spaces) {
  std::size_t total = 0;
  for (const SensorSet& set : entries.sets) total += set.points.size() * planes_a_sensor(set.kind);
  std::vector<SensorSet> all;
  std::size_t next = 0;
  const auto take_sets = [&](std::size_t end) {
    for (; next < end; ++next) all.push_back(std::move(entries.sets[next]));
  };
  for (const SpaceGrid& grid : entries.grids) {
    take_sets(grid.before);
    for (SensorSet& set : sets_in_spaces(grid, spaces, total)) {
      total += set.points.size() * planes_a_sensor(set.kind);
      all.push_back(std::move(set));
    }
  }
  take_sets(entries.sets.size());
  UniqueNames names;
  for (SensorSet& set : all) set.name = names.take(set.name);
  return all;
}

}  // namespace clerestory
