#pragma once
// Where a fuzz target puts its input, and what came of it.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace clerestory {

struct FuzzTally {
  long read = 0, refused = 0,
       broke_down = 0;  ///< broke_down: refused because the importer crashed or hung in its child
};
inline FuzzTally fuzz_tally;

/// Folder of this target's files, under the current one. The last input stays there, to be tried again.
inline std::filesystem::path fuzz_folder() {
  const std::filesystem::path folder = std::filesystem::path("fuzz_work") / FUZZ_NAME;
  std::filesystem::create_directories(folder);
  return folder;
}

inline std::filesystem::path write_fuzz_input(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path file = fuzz_folder() / ("last_input" FUZZ_EXTENSION);
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return file;
}

}  // namespace clerestory
