#pragma once
// The "luminaires" of a scene file.

#include <filesystem>
#include <string>

#include "io/scene_file/json_object.h"
#include "io/scene_file/material_rules.h"
#include "solver/model/scene.h"

namespace clerestory {

/// Reads all of them from the scene's root object into the scene; a photometric file that many name is read once.
///
/// folder  of the scene file; the names of photometric files are relative to it.
/// throws  InputError.
void read_luminaire_entries(const JsonObject& root, const std::string& file_name, const std::filesystem::path& folder,
                            ChannelCount& channels, Scene& scene);

}  // namespace clerestory
