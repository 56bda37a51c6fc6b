#pragma once
// The "sky" and "sun" of a scene file at several times.

#include <filesystem>
#include <span>
#include <string>

#include "io/scene_file/json_object.h"
#include "io/scene_file/material_rules.h"
#include "solver/model/scene.h"

namespace clerestory {

/// read_sky_entries() for each time, the scene's own "time" aside: scene.times, and in scene.lights the mean of what
/// the times have, with the luminaires that are there already. Warnings that several times share are given once.
///
/// times   at least one.
/// throws  InputError as read_sky_entries(), naming the time; when nothing of sky and sun goes by the time; and when
///         all of it is night.
void read_sky_of_times(const JsonObject& root, const std::string& file_name, const std::filesystem::path& folder,
                       std::span<const Moment> times, ChannelCount& channels, Scene& scene);

}  // namespace clerestory
