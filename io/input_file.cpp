#include "io/input_file.h"

#include <fstream>

#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {

std::string short_name(const std::filesystem::path& file) {
  const std::string name = clean_text(file.filename().string());
  return name.empty() ? clean_text(file.string()) : name;
}

void require_file(const std::filesystem::path& file, const std::string& place, const std::string& named) {
  std::error_code error;
  const auto type = std::filesystem::status(file, error).type();
  if (type == std::filesystem::file_type::directory)
    throw InputError(text(place, " '", quotable(named), "' is a folder; name a file in it"));
  if (type != std::filesystem::file_type::not_found) return;
  throw InputError(text(place, " '", quotable(named), "': there is no file ", clean_text(file.string()),
                        "; paths are relative to the scene file"));
}

void check_input_file(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) throw InputError(text(file.string(), ": no such file"));
  if (error) throw InputError(text(file.string(), ": cannot be read: ", error.message()));
  if (fs::is_directory(status)) throw InputError(text(file.string(), ": is a folder; name a file in it"));
  if (!fs::is_regular_file(status)) throw InputError(text(file.string(), ": is not a regular file"));
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error) throw InputError(text(file.string(), ": cannot be read: ", error.message()));
  if (bytes == 0) throw InputError(text(file.string(), ": the file is empty"));
  if (bytes > max_bytes) {
    throw InputError(text(file.string(), ": has ", bytes, " bytes; at most ", max_bytes, " are read from such a file"));
  }
}

std::string read_input_file(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  check_input_file(file, max_bytes);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(text(file.string(), ": cannot be opened; check its permissions"));
  std::string bytes(static_cast<std::size_t>(std::filesystem::file_size(file)), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (in.gcount() <= 0) throw InputError(text(file.string(), ": cannot be read"));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

std::string_view text_bytes(std::string_view bytes, const std::string& name) {
  const auto is_ascii_beside_zero = [&](std::size_t ascii, std::size_t zero) {
    const char c = bytes[ascii];
    return bytes[zero] == 0 && ((c >= ' ' && c <= '~') || c == '\n' || c == '\r' || c == '\t');
  };
  const bool has_mark = bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff");
  if (has_mark || (bytes.size() >= 4 && ((is_ascii_beside_zero(0, 1) && is_ascii_beside_zero(2, 3)) ||
                                         (is_ascii_beside_zero(1, 0) && is_ascii_beside_zero(3, 2)))))
    throw InputError(text(name, ": is UTF-16 text; save it as UTF-8"));
  return bytes.substr(bytes.starts_with("\xef\xbb\xbf") ? 3 : 0);
}

}  // namespace clerestory
