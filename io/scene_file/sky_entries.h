#pragma once
// The "sky", "sun", "location" and "time" of a scene file.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/formats/epw.h"
#include "io/scene_file/json_object.h"
#include "io/scene_file/material_rules.h"
#include "solver/model/scene.h"

namespace clerestory {

/// Several times of one scene, one after the other: each file is read for the first.
struct TimeOfSeries {
  Moment moment;  ///< in place of the scene's own time
  std::optional<Weather> weather;
  std::optional<Sky> image;
};

/// Reads all of them from the scene's root object into `lights`. Weather and image files are relative to `folder`.
///
/// series  null: the scene's own time. Of a series a sun that has set is no news.
/// returns the sun and the hour that they go by, when they go by a sun.
/// throws  InputError; also for a sky that needs the sun in a scene that does not say where it stands.
std::optional<Daylight> read_sky_entries(const JsonObject& root, const std::string& file_name,
                                         const std::filesystem::path& folder, ChannelCount& channels, LightSpec& lights,
                                         std::vector<std::string>& warnings, TimeOfSeries* series = nullptr);

/// Of "sky" the reflectance of the ground alone, for light of all hours; the other keys are known or refused, and not
/// looked at.
double read_ground(const JsonObject& root, const std::string& file_name);

/// The sky of --sky NAME[:LUX]; 10,000 lx unless it says otherwise. Skies that need no sun: uniform, cie-overcast, and
/// cie-general-TYPE for types 1, 3, 5 and 16.
Sky sky_of_option(std::string_view option);

}  // namespace clerestory
