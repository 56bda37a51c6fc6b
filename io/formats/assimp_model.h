#pragma once
// The door to Assimp.

#include "io/formats/model.h"

namespace clerestory {

/// Reads a .dae or .fbx file through Assimp in a child process: some damaged ones crash its importer.
///
/// throws  InputError, also for whatever goes wrong inside Assimp.
Model read_with_assimp(const std::filesystem::path& file);

}  // namespace clerestory
