#include "io/scene_file/place_and_time.h"

#include <chrono>

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

/// 2026-06-21T12:00, seconds allowed.
Moment read_time(const std::string& time, const std::string& place) {
  constexpr std::string_view kShape = "dddd-dd-ddTdd:dd:dd";
  bool fits = time.size() == 16 || time.size() == 19;
  for (std::size_t i = 0; fits && i < time.size(); ++i) {
    fits = kShape[i] == 'd' ? time[i] >= '0' && time[i] <= '9' : time[i] == kShape[i];
  }
  if (!fits) {
    throw InputError(text(place, " '", quotable(time), "' is not a time; write it as 2026-06-21T12:00, local standard ",
                          "time without a zone"));
  }
  const auto part = [&](std::size_t begin, std::size_t n) {
    return static_cast<int>(*to_number(std::string_view(time).substr(begin, n)));
  };
  const int seconds = time.size() == 19 ? part(17, 2) : 0;
  using namespace std::chrono;
  const year_month_day date(year(part(0, 4)), month(static_cast<unsigned>(part(5, 2))),
                            day(static_cast<unsigned>(part(8, 2))));
  if (!date.ok() || part(11, 2) > 23 || part(14, 2) > 59 || seconds > 59) {
    throw InputError(text(place, " '", time, "' does not exist; months are 01 to 12, days those of ",
                          "the month, hours 00 to 23, minutes and seconds 00 to 59"));
  }
  return {part(0, 4), part(5, 2), part(8, 2), part(11, 2) + part(14, 2) / 60.0 + seconds / 3600.0};
}

}  // namespace

PlaceAndTime read_place_and_time(const JsonObject& root, const std::string& file_name) {
  PlaceAndTime read;
  if (root.has("location")) {
    read_location(
        JsonObject(root.at("location"), file_name + ": location", {"latitude", "longitude", "timezone", "north"}),
        read);
  }
  if (const auto time = root.word("time")) {
    read.time = read_time(*time, root.place("time"));
    read.on_the_hour = read.time->hour == std::floor(read.time->hour);
  }
  return read;
}

}  // namespace clerestory
