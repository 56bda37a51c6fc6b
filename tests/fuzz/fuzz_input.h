#pragma once
// Where a fuzz target puts its input, and what came of it.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "solver/model/error.h"

namespace clerestory {

struct FuzzTally {
  long read = 0, refused = 0,
       broke_down = 0;  ///< refused because a library crashed, hung or took too much in its child process
};
inline FuzzTally fuzz_tally;

/// Ends the program, with a word why.
inline void require(bool holds, const std::string& what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz_%s: %s\n", FUZZ_NAME, what.c_str());
  std::abort();
}

/// Folder of this target's files, under the current one. The last input stays there, to be tried again.
inline std::filesystem::path fuzz_folder() {
  const std::filesystem::path folder = std::filesystem::path("fuzz_work") / FUZZ_NAME;
  std::filesystem::create_directories(folder);
  return folder;
}

/// For readers that take a file. Where many inputs are tried the current folder lies in memory (campaign.sh).
inline const std::filesystem::path& write_fuzz_input(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path file = fuzz_folder() / ("last_input" FUZZ_EXTENSION);
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return file;
}

/// Calls work(), which may refuse its input in a message of one line. Whatever else it throws ends the program.
template <class Work>
void read_or_refuse(const Work& work) {
  try {
    work();
    ++fuzz_tally.read;
  } catch (const InputError& error) {
    ++fuzz_tally.refused;
    const std::string message = error.what();
    require(message.size() > 10 && message.find('\n') == message.npos, "the message is empty or has several lines");
    if (message.find(" importer ") != message.npos) ++fuzz_tally.broke_down;
  }
}

}  // namespace clerestory
