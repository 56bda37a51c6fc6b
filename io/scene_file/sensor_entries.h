#pragma once
// The "sensors" of a scene file: point files and grids.

#include <filesystem>
#include <string>
#include <vector>

#include "io/scene_file/json_object.h"
#include "solver/model/sensors.h"

namespace clerestory {

/// A grid has its first point at `origin` and goes on in steps of `spacing` along u and v, ends included. Normals are
/// those of the set's kind: up, horizontal, towards the camera; of cylinders the axis.
///
/// folder  where the files of sensors are looked for.
/// throws  InputError; also when all of them are more than kMaxSensors points, cylindrical ones counted by their
/// planes.
std::vector<SensorSet> read_sensor_entries(const Json& sensors, const std::string& file_name,
                                           const std::filesystem::path& folder);

}  // namespace clerestory
