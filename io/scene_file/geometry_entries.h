#pragma once
// "geometry" of a scene file: which models, and where they stand.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/scene_file/json_object.h"
#include "io/scene_file/place_model.h"

namespace clerestory {

inline constexpr std::uintmax_t kMaxSceneFileBytes = 16u << 20;
/// A scene file as an object that may have what scene files have.
JsonObject root_of_scene(const Json& json, const std::string& file_name);

struct GeometryEntry {
  std::string where;  ///< words for messages: "office.json: geometry[0]"
  std::filesystem::path file;
  Placement placement;
};

/// throws  InputError, also where a model is not there.
std::vector<GeometryEntry> geometry_entries(const JsonObject& root, const std::string& file_name,
                                            const std::filesystem::path& folder);

/// The same of a scene file of which nothing else is read.
std::vector<GeometryEntry> read_geometry_entries(const std::filesystem::path& file);

}  // namespace clerestory
