#include "io/annual/file_digest.h"

#include <cstdint>
#include <fstream>
#include <vector>

#include "io/input_file.h"
#include "solver/model/error.h"

namespace clerestory {

std::string file_digest(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::uint64_t h = 0xcbf29ce484222325;
  for (std::vector<char> block(1 << 16); in;) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    for (std::streamsize i = 0; i < in.gcount(); ++i)
      h = (h ^ static_cast<unsigned char>(block[static_cast<std::size_t>(i)])) * 0x100000001b3;
  }
  if (!in.eof()) throw InputError(short_name(file) + ": can no longer be read; was it moved while the program ran?");
  std::string digits(16, '0');
  for (std::size_t k = 16; k-- > 0; h >>= 4) digits[k] = "0123456789abcdef"[h & 15];
  return digits;
}

}  // namespace clerestory
