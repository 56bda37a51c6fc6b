#include "io/find_file.h"

#include <algorithm>
#include <string>

#include "io/text.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code error;  // a name that is too long is no file
  return fs::is_regular_file(path, error);
}

std::string with_slashes(std::string_view named) {
  std::string path(named);
  std::replace(path.begin(), path.end(), '\\', '/');
  return path;
}

/// `part` of a folder, or what differs from it in case only.
std::optional<fs::path> entry(const fs::path& folder, const fs::path& part) {
  std::error_code error;
  if (fs::exists(folder / part, error)) return folder / part;
  const std::string wanted = to_lower(part.string());
  std::optional<fs::path> found;
  for (fs::directory_iterator at(folder.empty() ? "." : folder, error), end; !error && at != end; at.increment(error)) {
    const fs::path name = at->path().filename();
    if (to_lower(name.string()) == wanted && (!found || folder / name < *found)) found = folder / name;
  }
  return found;
}

std::optional<fs::path> find_any_case(fs::path at, const fs::path& named) {
  if (named.is_absolute()) at = named.root_path();
  for (const fs::path& part : named.relative_path()) {
    const auto next = entry(at, part);
    if (!next) return std::nullopt;
    at = *next;
  }
  return is_file(at) ? std::optional(at) : std::nullopt;
}

}  // namespace

std::string_view unquoted(std::string_view s) {
  s = trimmed(s);
  const bool is_quoted = s.size() >= 2 && s.front() == s.back() && (s.front() == '"' || s.front() == '\'');
  return is_quoted ? trimmed(s.substr(1, s.size() - 2)) : s;
}

std::optional<fs::path> find_path(const fs::path& folder, std::string_view named) {
  for (const std::string_view name : {named, unquoted(named)})
    if (is_file(folder / name)) return folder / name;
  const std::string name = with_slashes(unquoted(named));
  return name.empty() ? std::nullopt : find_any_case(folder, name);
}

std::optional<fs::path> find_file(const fs::path& folder, std::string_view named) {
  if (auto found = find_path(folder, named)) return found;
  const std::string name = fs::path(with_slashes(unquoted(named))).filename().string();
  return name.empty() ? std::nullopt : find_path(folder, name);
}

}  // namespace clerestory
