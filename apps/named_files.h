#pragma once
// The files that a command line names, and those of the scene: none is written that is read.

#include <filesystem>
#include <string>
#include <vector>

namespace clerestory {

inline constexpr const char* kInput = "INPUT";  ///< option of the file that a command is about

struct NamedFile {
  std::string option, file;  ///< "-o", "out.vtp"; the file is empty when it was not asked for
  bool is_written = true;
  std::string advice = "choose another file for it";
};

/// A slip of the pen must not cost the user a scene, nor one result the other.
/// throws  InputError when a file is written that is also read, or written twice. Links do not hide it.
void refuse_to_overwrite(const std::vector<NamedFile>& files);

/// throws  InputError when one that is written is among those that the scene was read from.
void refuse_to_overwrite(const std::vector<NamedFile>& files, const std::vector<std::filesystem::path>& of_scene);

}  // namespace clerestory
