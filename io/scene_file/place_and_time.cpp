#include "io/scene_file/place_and_time.h"

#include <cmath>

#include "io/moment.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

void read_location(const JsonObject& location, PlaceAndTime& read) {
  const auto latitude =
      location.number("latitude", {.low = -90, .high = 90, .advice = "it is in degrees, north positive"});
  const auto longitude =
      location.number("longitude", {.low = -180, .high = 180, .advice = "it is in degrees, east positive"});
  const auto timezone = location.number("timezone", {.low = -14, .high = 14, .advice = "it is in hours ahead of UTC"});
  const auto north =
      location.number("north", {.low = -360, .high = 360, .advice = "it is in degrees clockwise from +y"});
  read.north_deg = north.value_or(0);
  if (!latitude && !longitude && !timezone) return;
  for (const std::string_view key : {"latitude", "longitude", "timezone"}) {
    if (location.has(key)) continue;
    throw InputError(text(location.place(key), " is missing; a place needs latitude and longitude in degrees and its ",
                          "timezone in hours ahead of UTC"));
  }
  read.place = Place{*latitude, *longitude, *timezone};
}

}  // namespace

PlaceAndTime read_place_and_time(const JsonObject& root, const std::string& file_name,
                                 const std::optional<Moment>& instead) {
  PlaceAndTime read;
  if (root.has("location")) {
    read_location(
        JsonObject(root.at("location"), file_name + ": location", {"latitude", "longitude", "timezone", "north"}),
        read);
  }
  if (const auto time = root.word("time")) read.time = read_moment(*time, root.place("time"));
  if (instead) read.time = instead;
  read.on_the_hour = read.time && read.time->hour == std::floor(read.time->hour);
  return read;
}

}  // namespace clerestory
