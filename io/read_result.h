#pragma once
// A result read back: .vtp -> triangles with their light, and what is around them. VTK stays inside.

#include <filesystem>

#include "solver/model/written_result.h"

namespace clerestory {

/// throws  InputError when there is no such file, when VTK finds it damaged, when it has other cells than triangles or
///         points that are not there, when `clerestory solve` did not write it, or another version of it that wrote
///         otherwise.
WrittenResult read_result(const std::filesystem::path& file);

/// The array of that name on the points.
/// throws  InputError that names those there are.
const WrittenArray& array_of_points(const WrittenResult& result, const std::string& name);

}  // namespace clerestory
