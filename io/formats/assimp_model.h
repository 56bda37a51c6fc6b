#pragma once
// The door to Assimp.

#include "io/formats/model.h"

namespace clerestory {

/// Reads a file through Assimp in a child process, since its importers crash on some damaged files.
///
/// throws  InputError, also for whatever goes wrong inside Assimp.
Model read_with_assimp(const std::filesystem::path& file);

}  // namespace clerestory
