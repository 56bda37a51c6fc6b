#pragma once
// Files that come with the program.

#include <filesystem>

namespace clerestory {

/// Where `path` is relative to the folder above the program's own, as in the build tree so where it is installed; for
/// a program that uses the library, where that is not.
std::filesystem::path beside_program(const std::filesystem::path& path);

}  // namespace clerestory
