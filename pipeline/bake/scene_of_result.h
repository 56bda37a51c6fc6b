#pragma once
// The scene that a result was solved for, read again.

#include <filesystem>
#include <string>
#include <vector>

#include "solver/model/scene.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// Files that are there and may be the scene's: the likeliest first. None of them is to be written over.
std::vector<std::filesystem::path> places_of_scene(const WrittenResult& result, const std::filesystem::path& file);

/// result    read from this file
/// instead   the scene's file now; empty: where it was, or else in the same place as seen from the result, or beside it
/// throws    InputError when it is nowhere, or read_scene() refuses it
Scene read_scene_of(const WrittenResult& result, const std::filesystem::path& file,
                    const std::filesystem::path& instead);

}  // namespace clerestory
