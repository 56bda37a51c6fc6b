#pragma once
// "rooms" of a scene file.

#include <string>

#include "io/scene_file/json_object.h"
#include "solver/model/scene.h"

namespace clerestory {

/// Sets Scene::rooms from a list of { "name", "surfaces": [patterns] }; * and ? stand for text and a letter in names of
/// surfaces, and the first room that matches has them. A pattern that matches no surface is a warning.
///
/// scene   with its surfaces.
/// throws  InputError naming the place.
void read_room_entries(const Json& rooms, const std::string& file_name, Scene& scene);

}  // namespace clerestory
