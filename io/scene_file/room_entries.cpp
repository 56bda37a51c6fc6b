#include "io/scene_file/room_entries.h"

#include "io/scene_file/material_rules.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {

void read_room_entries(const Json& rooms, const std::string& file_name, Scene& scene) {
  const std::string where = file_name + ": rooms";
  if (!rooms.is_array()) refuse_type(where, "a list of rooms", rooms);
  for (std::size_t r = 0; r < rooms.size(); ++r) {
    const JsonObject entry(rooms[r], where + "[" + std::to_string(r) + "]", {"name", "surfaces"});
    const auto name = entry.word("name");
    if (!name || name->empty()) throw InputError(entry.where() + " has no \"name\"");
    if (!entry.has("surfaces") || !entry.at("surfaces").is_array() || entry.at("surfaces").empty())
      throw InputError(entry.where() + " has no \"surfaces\": a list of names, such as [\"floor_1*\"]");
    NamedSurfaces room{*name, std::vector<bool>(scene.surfaces.size())};
    for (const Json& pattern : entry.at("surfaces")) {
      if (!pattern.is_string()) refuse_type(entry.place("surfaces"), "a list of text", pattern);
      bool any = false;
      for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        if (!matches(pattern.get<std::string>(), scene.surfaces[s])) continue;
        any = true;
        room.has_surface[s] = true;
      }
      if (!any)
        scene.warnings.push_back(text(entry.place("surfaces"), ": '", quotable(pattern.get<std::string>()),
                                      "' matches no surface; surfaces have the names of the model's objects"));
    }
    scene.rooms.push_back(std::move(room));
  }
}

}  // namespace clerestory
