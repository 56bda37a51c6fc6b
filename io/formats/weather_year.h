#pragma once
// A weather file's year as skies and suns.

#include "io/formats/epw.h"
#include "solver/model/daylight_year.h"

namespace clerestory {

/// Part of the hours with the sun up that may lack their radiation; more make a daylight autonomy wrong by a point.
inline constexpr double kMostMissing = 0.01;

/// Each hour is made as a scene file's "weather" makes one: the sun at the middle of the hour's part in which it is up,
/// Perez' sky, the file's illuminances or, where it has none, those of Perez' efficacies. Hours without radiation are
/// dark, up to kMostMissing of those with the sun up. 29 February is left out. Both, and derived illuminances, go into
/// `warnings`, and what Weather warns of, and direct light of hours without the sun where it is more than 1 % of all.
///
/// place               where the sun is computed for.
/// north_deg           of the scene's north, clockwise from +y.
/// ground_reflectance  of the virtual ground, [0, 1].
/// throws  InputError naming file and lines: hours that are there twice (several years), too many missing, no
/// radiation. 0.2 s.
DaylightYear daylight_year(const Weather& weather, const Place& place, double north_deg, double ground_reflectance);

}  // namespace clerestory
