#pragma once
// The light of sky and sun in each hour of a year, as a weather file and a place make it.

#include <string>
#include <vector>

#include "solver/model/light_spec.h"
#include "solver/model/solar_position.h"
#include "solver/model/units.h"

namespace clerestory {

/// One hour in which there is light. On open ground it gives diffuse_horizontal_lux + direct_normal_lux() * sun.z.
struct DaylightHour {
  int hour = 0;                      ///< of the year, from `hour` to hour + 1, 0 to 8759; local standard time
  Moment moment;                     ///< that sun and sky stand for: the middle of the hour's part with the sun up
  Vec3 sun{0, 0, 1};                 ///< unit, to the sun, up or not
  bool sun_up = false;               ///< the sun stands above the horizon at that moment
  double sun_normal_irradiance = 0;  ///< on a plane that faces the sun, 0 without sun_up [W/m2 of kWhiteEfficacy]
  Sky sky;                           ///< Perez'; dark where there is no diffuse light
  double diffuse_horizontal_lux = 0;

  double direct_normal_lux() const { return sun_normal_irradiance * kWhiteEfficacy; }
};

struct DaylightYear {
  std::string file, city;           ///< the weather file's name, and what it says of the place
  Place place;                      ///< that the sun was computed for
  double north_deg = 0;             ///< of the scene, clockwise from +y
  std::vector<DaylightHour> hours;  ///< those with light, ascending
  int missing_hours = 0;            ///< with the sun up and without radiation: they count as dark
  std::vector<std::string> warnings;
};

}  // namespace clerestory
