#pragma once
// Folders that results are written into.

#include <filesystem>
#include <system_error>

#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {

/// With the folders above it; one that is there already stays as it is.
///
/// throws  InputError naming it and why it cannot be made.
inline void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (std::filesystem::is_directory(folder)) return;
  throw InputError(text(folder.string(), ": the folder cannot be made: ",
                        error ? error.message() : std::string("a file of that name is in the way"),
                        "; name another place"));
}

}  // namespace clerestory
