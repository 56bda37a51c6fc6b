#pragma once
// The "sensors" of a scene file: point files and grids.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/scene_file/json_object.h"
#include "solver/model/named_space.h"
#include "solver/model/sensors.h"

namespace clerestory {

/// A grid in each space that a pattern matches, for when the models have been read.
struct SpaceGrid {
  std::size_t before = 0;  ///< index of the set that comes after those of this grid
  JsonObject object;       ///< valid as long as the JSON that it was read from
  std::string pattern;
  SensorKind kind{};
  std::optional<double> threshold;
};

struct SensorEntries {
  std::vector<SensorSet> sets;
  std::vector<SpaceGrid> grids;
};

/// A grid has its first point at `origin` and goes on in steps of `spacing` along u and v, ends included. Normals are
/// those of the set's kind: up, horizontal, towards the camera; of cylinders the axis.
///
/// folder  where the files of sensors are looked for.
/// throws  InputError; also when all of them are more than kMaxSensors points, cylindrical ones counted by their
/// planes.
SensorEntries read_sensor_entries(const Json& sensors, const std::string& file_name,
                                  const std::filesystem::path& folder);

/// All sets, those in spaces too: points in steps of `spacing` along the walls, in the middle of their cells, `height`
/// above the floor below them. One set a space that has a volume and is named so. A name that is
/// taken gets a number: "desk", "desk 2".
///
/// throws  InputError when no space matches, or no point of a grid is inside, or they are too many.
std::vector<SensorSet> sets_of(SensorEntries entries, const std::vector<NamedSpace>& spaces);

}  // namespace clerestory
