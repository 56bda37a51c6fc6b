#pragma once
// Places whose longitude and time zone do not fit each other, as they come out of swapped signs.

#include <cmath>
#include <string>
#include <vector>

#include "io/text.h"
#include "solver/model/solar_position.h"

namespace clerestory {

/// Hours between the noon of the sun's mean course and that of the clock.
inline double hours_off(const Place& place) { return std::remainder(place.longitude_deg / 15 - place.timezone, 24); }
/// More than any time zone of the world asks for, but for a strip of western China.
inline bool is_odd(const Place& place) { return std::abs(hours_off(place)) > 3; }

/// who  what says the place: a file, or a key of one.
inline void warn_of_place(const std::string& who, const Place& place, std::vector<std::string>& warnings) {
  if (!is_odd(place)) return;
  warnings.push_back(text(who, ": longitude ", place.longitude_deg, " and timezone ", place.timezone, " are ",
                          std::round(std::abs(hours_off(place)) * 10) / 10,
                          " hours of the sun apart; longitude counts east positive, west negative, and timezone in ",
                          "hours ahead of UTC (gensky and gendaylit count both the other way round)"));
}

}  // namespace clerestory
