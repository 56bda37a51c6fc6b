#pragma once
// Scene JSON -> Scene.

#include <filesystem>

#include "io/read_scene.h"

namespace clerestory {

/// Reads a scene file as docs/models.md and the pages beside it describe it, and the models it names.
///
/// options  what is said of scene files.
/// throws  InputError naming file and line, or the key, what is wrong and what is allowed.
Scene read_scene_file(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace clerestory
