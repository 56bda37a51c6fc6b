#include "pipeline/bake/scene_of_result.h"

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

}  // namespace

std::vector<std::filesystem::path> places_of_scene(const WrittenResult& result, const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  const std::string input = text_of(result, "input").value_or("");
  const fs::path folder = file.parent_path();
  std::vector<fs::path> places;
  for (const fs::path& place : {fs::path(input), folder / input, folder / fs::path(input).filename()}) {
    std::error_code unknown;
    if (!input.empty() && fs::is_regular_file(place, unknown)) places.push_back(place);
  }
  return places;
}

Scene read_scene_of(const WrittenResult& result, const std::filesystem::path& file,
                    const std::filesystem::path& instead) {
  namespace fs = std::filesystem;
  const ReadOptions options{text_of(result, "settings.unit"), text_of(result, "settings.up"),
                            text_of(result, "settings.sky")};
  if (!instead.empty()) return read_scene(instead, options);
  const std::vector<fs::path> places = places_of_scene(result, file);
  if (!places.empty()) return read_scene(places.front(), options);
  const std::string input = text_of(result, "input").value_or("");
  throw InputError(text(result.file, ": was solved for ", input.empty() ? "a scene without a name" : clean_text(input),
                        ", which is not there any more; say where it is: --scene FILE."));
}

}  // namespace clerestory
