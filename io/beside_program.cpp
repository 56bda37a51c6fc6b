#include "io/beside_program.h"

#include <system_error>

namespace clerestory {

std::filesystem::path beside_program(const std::filesystem::path& path) {
  std::error_code error;  // without /proc there is no such place
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path().parent_path() / path;
}

}  // namespace clerestory
