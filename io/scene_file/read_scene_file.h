#pragma once
// Scene JSON -> Scene.

#include <filesystem>
#include <span>

#include "solver/model/scene.h"

namespace clerestory {

/// Reads a scene file as docs/models.md and the pages beside it describe it, and the models it names.
///
/// times   as of ReadOptions.
/// throws  InputError naming file and line, or the key, what is wrong and what is allowed.
Scene read_scene_file(const std::filesystem::path& file, std::span<const Moment> times = {});

}  // namespace clerestory
