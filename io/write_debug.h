#pragma once
// What the hierarchical method did -> four .vtp files. VTK stays inside.

#include <array>
#include <filesystem>

#include "io/atomic_file.h"
#include "solver/model/hierarchy_debug.h"

namespace clerestory {

/// hierarchy.vtp, links.vtp, rays.vtp and error.vtp in `folder`.
std::array<std::filesystem::path, 4> debug_files(const std::filesystem::path& folder);

/// Makes the folder where there is none, and its parents.
/// throws  InputError when the files could not be written; call it before a long computation.
void check_debug_folder(const std::filesystem::path& folder);

/// Each shape is a cell, its values are cell data (what they mean: solver/model/hierarchy_debug.h).
///
/// origin  of the local frame [m].
/// throws  InputError when a file cannot be written; std::runtime_error when a value is not finite.
void write_debug(Outputs& outputs, const std::filesystem::path& folder, const HierarchyDebug& debug,
                 const Vec3& origin);

}  // namespace clerestory
