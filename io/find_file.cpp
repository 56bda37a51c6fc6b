#include "io/find_file.h"

#include <algorithm>

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

}  // namespace

const FileFinder::Listing& FileFinder::listing(const fs::path& folder) {
  const auto [at, is_new] = listings_.try_emplace(folder.lexically_normal());
  if (!is_new) return at->second;
  std::error_code error;
  for (fs::directory_iterator next(folder.empty() ? "." : folder, error), end; !error && next != end;
       next.increment(error)) {
    const fs::path name = next->path().filename();
    fs::path& first = at->second[to_lower(name.string())];
    if (first.empty() || name < first) first = name;
  }
  return at->second;
}

/// `part` of a folder, or what differs from it in case only.
std::optional<fs::path> FileFinder::entry(const fs::path& folder, const fs::path& part) {
  std::error_code error;
  if (fs::exists(folder / part, error)) return folder / part;
  const Listing& names = listing(folder);
  const auto found = names.find(to_lower(part.string()));
  return found == names.end() ? std::nullopt : std::optional(folder / found->second);
}

std::optional<fs::path> FileFinder::any_case(fs::path at, const fs::path& named) {
  if (named.is_absolute()) at = named.root_path();
  for (const fs::path& part : named.relative_path()) {
    const auto next = entry(at, part);
    if (!next) return std::nullopt;
    at = *next;
  }
  return is_file(at) ? std::optional(at) : std::nullopt;
}

std::optional<fs::path> FileFinder::path(const fs::path& folder, std::string_view named) {
  for (const std::string_view name : {named, unquoted(named)})
    if (is_file(folder / name)) return folder / name;
  const std::string name = with_slashes(unquoted(named));
  return name.empty() ? std::nullopt : any_case(folder, name);
}

std::optional<fs::path> FileFinder::file(const fs::path& folder, std::string_view named) {
  if (auto found = path(folder, named)) return found;
  const std::string whole = with_slashes(unquoted(named)), last = fs::path(whole).filename().string();
  return last.empty() || last == whole ? std::nullopt : path(folder, last);
}

}  // namespace clerestory
