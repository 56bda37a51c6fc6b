#pragma once
// The "sky", "sun", "location" and "time" of a scene file.

#include <string>
#include <vector>

#include "io/scene_file/json_object.h"
#include "io/scene_file/material_rules.h"
#include "solver/model/light_spec.h"

namespace clerestory {

/// Reads all of them from the scene's root object into `lights`.
void read_sky_entries(const JsonObject& root, const std::string& file_name, ChannelCount& channels, Lights& lights,
                      std::vector<std::string>& warnings);

/// The sky of --sky NAME[:LUX]; 10,000 lx unless it says otherwise.
Sky sky_of_option(std::string_view option);

}  // namespace clerestory
