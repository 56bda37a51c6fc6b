#pragma once
// The scene that a result was solved for, read again.

#include <filesystem>
#include <string>
#include <vector>

#include "solver/model/scene.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// The scene's file: where it was, or else in the same place as seen from the result, or beside it.
///
/// result  read from this file
/// throws  InputError with that advice when it is nowhere
std::filesystem::path file_of_scene(const WrittenResult& result, const std::filesystem::path& file,
                                    const std::string& advice);

/// Those files that the scene was read from which are still there, where file_of_scene() would look.
std::vector<std::filesystem::path> files_of_scene(const WrittenResult& result, const std::filesystem::path& file);

/// instead   the scene's file now; empty: file_of_scene()
/// throws    InputError when it is nowhere, or read_scene() refuses it
Scene read_scene_of(const WrittenResult& result, const std::filesystem::path& file,
                    const std::filesystem::path& instead);

}  // namespace clerestory
