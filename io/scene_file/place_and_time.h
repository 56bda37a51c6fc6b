#pragma once
// The "location" and "time" of a scene file.

#include <optional>
#include <string>

#include "io/scene_file/json_object.h"
#include "solver/model/solar_position.h"

namespace clerestory {

struct PlaceAndTime {
  std::optional<Place> place;
  double north_deg = 0;  ///< of the scene's north, clockwise from +y
  std::optional<Moment> time;
  bool on_the_hour = false;  ///< time names an hour and neither minutes nor seconds
};

/// instead  of the scene's own time, where there is one.
/// throws   InputError; a location has latitude, longitude and timezone, or north alone.
PlaceAndTime read_place_and_time(const JsonObject& root, const std::string& file_name,
                                 const std::optional<Moment>& instead = {});

}  // namespace clerestory
