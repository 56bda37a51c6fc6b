#pragma once
// The door to Assimp.

#include "io/formats/model.h"

namespace clerestory {

/// Reads a .dae, .fbx or .ifc file through Assimp in a child process: of damaged IFC files one in five crashes its
/// importer, and some DAE and FBX files do.
///
/// throws  InputError, also for whatever goes wrong inside Assimp.
Model read_with_assimp(const std::filesystem::path& file);

}  // namespace clerestory
