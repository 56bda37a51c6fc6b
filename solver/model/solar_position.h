#pragma once
// Where the sun stands, from place and time.

#include "solver/model/vec.h"

namespace clerestory {

struct Place {
  double latitude_deg = 0;   ///< north positive
  double longitude_deg = 0;  ///< east positive
  double timezone = 0;       ///< hours ahead of UTC, of the local standard time
};

/// Local standard time: clocks without daylight saving.
struct Moment {
  int year = 2001, month = 1, day = 1;
  double hour = 12;  ///< since midnight, [0, 24)
};

/// Day of the year of a date that exists, 1 to 366.
int day_of_year(const Moment& moment);

/// Direction as compasses and theodolites give it [degrees].
struct Horizontal {
  double elevation_deg = 0;
  double azimuth_deg = 0;  ///< clockwise from north, [0, 360)
};

/// Centre of the sun without refraction, seen from the ground (parallax included).
/// Good to 0.01 degrees for some centuries around 2000.
/// Source: Meeus, "Astronomical Algorithms", 1998, chapters 12, 22, 25 (low accuracy).
Horizontal sun_without_air(const Place& place, const Moment& moment);

/// What the atmosphere adds to an elevation [degrees]; 0 for a sun that stays below the horizon all the same.
/// Source: Saemundsson 1986 as in Reda & Andreas, "Solar position algorithm", 2004.
double refraction_deg(double elevation_deg, double pressure_hPa = 1010, double temperature_c = 10);

/// Where the sun is seen, and its light comes from: refraction of the mean atmosphere at sea level included.
Horizontal sun_position(const Place& place, const Moment& moment);

/// Unit direction in a scene with z up whose north is +y turned clockwise by north_deg.
Vec3 scene_direction(const Horizontal& direction, double north_deg = 0);
/// The way back: elevation and azimuth of a unit direction of the scene.
Horizontal compass_direction(const Vec3& direction, double north_deg = 0);

}  // namespace clerestory
