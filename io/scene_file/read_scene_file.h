#pragma once
// Scene JSON -> Scene.

#include <filesystem>

#include "io/formats/model.h"

namespace clerestory {

/// Reads a scene file as docs/models.md and the pages beside it describe it, and the models it names.
///
/// throws  InputError naming file and line, or the key, what is wrong and what is allowed.
Scene read_scene_file(const std::filesystem::path& file, const ShouldStop& should_stop = {});

}  // namespace clerestory
