#include "io/scene_file/sensor_entries.h"

#include <algorithm>
#include <cmath>

#include "io/input_file.h"
#include "io/read_sensors.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

/// Steps of `spacing` that fit into `length`; a length that is a whole multiple in decimal counts as one.
double steps(double length, double spacing) { return std::floor(length / spacing * (1 + 1e-9) + 1e-9); }

SensorSet read_grid(const JsonObject& object, std::size_t room_left) {
  for (const std::string_view key : {"origin", "u", "v", "spacing"}) object.at(key);
  const Vec3 origin = *object.vector("origin", kCoordinate), u = *object.vector("u", kCoordinate),
             v = *object.vector("v", kCoordinate);
  const double spacing =
      *object.number("spacing", {.low = 0, .high = 1e12, .low_allowed = false, .advice = "it is in metres"});
  Vec3 normal;
  if (object.has("normal")) {
    normal = *object.unit_vector("normal");
  } else {
    normal = normalized(cross(normalized(u), normalized(v)));
    if (length(normal) == 0)
      throw InputError(text(object.place("normal"), " is missing, and u and v span no plane to take it from"));
  }
  const double along_u = steps(length(u), spacing) + 1, along_v = steps(length(v), spacing) + 1;
  if (!(along_u * along_v <= static_cast<double>(room_left))) {
    throw InputError(text(object.place("spacing"), " = ", spacing, " makes ", along_u, " x ", along_v,
                          " points; at most ", kMaxSensors, " in one scene"));
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
  return sensors;
}

}  // namespace

std::vector<SensorSet> read_sensor_entries(const Json& sensors, const std::string& file_name,
                                           const std::filesystem::path& folder) {
  std::vector<SensorSet> sets;
  std::size_t total = 0;
  for (const Json& entry : as_array(sensors, file_name + ": sensors", "sensor sets")) {
    const JsonObject object(entry, text(file_name, ": sensors[", sets.size(), "]"),
                            {"name", "file", "origin", "u", "v", "spacing", "normal"});
    if (object.has("file")) {
      for (const std::string_view key : {"origin", "u", "v", "spacing", "normal"}) {
        if (object.has(key)) throw InputError(text(object.place(key), " does not go with \"file\"; keep one of them"));
      }
      const std::string file = *object.word("file");
      require_file(folder / file, object.place("file"), file);
      sets.push_back(read_sensors(folder / file));
    } else {
      sets.push_back(read_grid(object, kMaxSensors - total));
    }
    if (const auto name = object.word("name")) sets.back().name = *name;
    if (sets.back().name.empty()) sets.back().name = text("sensors ", sets.size());
    total += sets.back().points.size();
    if (total > kMaxSensors)
      throw InputError(text(object.where(), ": more than ", kMaxSensors, " points in one scene"));
  }
  return sets;
}

}  // namespace clerestory
