#pragma once
// The "luminaires" of a scene file.

#include <string>
#include <vector>

#include "io/scene_file/json_object.h"
#include "io/scene_file/material_rules.h"
#include "solver/model/light_spec.h"

namespace clerestory {

/// Reads all of them from the scene's root object into `lights`.
///
/// throws  InputError; also for what a later version will read (IES and LDT files), naming what can be used instead.
void read_light_entries(const JsonObject& root, const std::string& file_name, ChannelCount& channels, Lights& lights,
                        std::vector<std::string>& warnings);

}  // namespace clerestory
