#include "pipeline/scene_of_result.h"

#include <optional>
#include <system_error>

#include "io/read_scene.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

std::optional<std::string> text_of(const WrittenResult& result, const char* name) {
  const auto at = result.texts.find(name);
  if (at == result.texts.end() || at->second.empty() || at->second.front().empty()) return {};
  return at->second.front();
}

/// A file by the name that it had for who solved: there, in the same place as seen from the result, or beside it.
std::optional<std::filesystem::path> find(const std::filesystem::path& named, const std::filesystem::path& result) {
  namespace fs = std::filesystem;
  const fs::path folder = result.parent_path();
  for (const fs::path& place : {named, folder / named, folder / named.filename()}) {
    std::error_code unknown;
    if (!named.empty() && fs::is_regular_file(place, unknown)) return place;
  }
  return {};
}

}  // namespace

std::filesystem::path file_of_scene(const WrittenResult& result, const std::filesystem::path& file,
                                    const std::string& advice) {
  const std::string input = text_of(result, "input").value_or("");
  if (const auto place = find(input, file)) return *place;
  throw InputError(text(result.file, ": was solved for ",
                        input.empty() ? "a scene without a name" : quotable(input, 200),
                        ", which is not there any more; ", advice, "."));
}

std::vector<std::filesystem::path> files_of_scene(const WrittenResult& result, const std::filesystem::path& file) {
  std::vector<std::filesystem::path> files;
  for (const std::string& named : result.around.files)
    if (const auto place = find(named, file)) files.push_back(*place);
  return files;
}

Scene read_scene_of(const WrittenResult& result, const std::filesystem::path& file,
                    const std::filesystem::path& instead) {
  ReadOptions options;
  options.unit = text_of(result, "settings.unit"), options.up = text_of(result, "settings.up");
  options.sky = text_of(result, "settings.sky"), options.gloss = text_of(result, "settings.gloss");
  return read_scene(instead.empty() ? file_of_scene(result, file, "say where it is: --scene FILE") : instead, options);
}

}  // namespace clerestory
