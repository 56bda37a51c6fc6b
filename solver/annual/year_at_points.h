#pragma once
// A year of illuminance at points, of which nothing is kept but what the caller keeps.

#include <span>
#include <vector>

#include "solver/annual/reflected_daylight.h"
#include "solver/annual/sun_on_points.h"
#include "solver/annual/year_light.h"
#include "solver/illumination/illumination.h"
#include "solver/sampling/gather_pattern.h"

namespace clerestory {

/// A point where light is asked for: the mean over some places.
struct PlacesOfPoint {
  std::vector<ReceivingPoint> at;
  std::vector<double> weight;  ///< of each, sum 1
};

/// What is alike for all points, of windows in one state.
struct YearScene {
  const Illumination& light;  ///< for a gather, under any sky and no sun, of the elements that `reflected` is of
  const SkyParts& fine;
  const ReflectedDaylight& reflected;
  const YearLight& year;
  std::vector<SunOfHour> suns;             ///< of the hours with sun, ascending
  std::vector<std::size_t> hour_of_sun;    ///< in `year`
  std::vector<std::uint32_t> part_of_sun;  ///< fine, by sun
  double plan_reach;  ///< how far from where it was made a gather's plan serves points that face alike [m]
  std::vector<std::vector<std::uint32_t>> parts_around;  ///< of each fine part: those within kAround of it, itself too
};

/// hours     that `year` is of.
/// sun_rays  to the disc, where its pilots disagree: the point lies in half-shadow.
/// Everything outlives it.
YearScene year_scene(const Illumination& light, const SkyParts& fine, const ReflectedDaylight& reflected,
                     const YearLight& year, std::span<const DaylightHour> hours, double plan_reach,
                     std::size_t sun_rays, std::uint64_t seed);

/// Illuminance of points by the hour [lx]: total and direct sun, points x H by point, replaced.
///
/// The sun is looked for where a point has seen sky within 15 degrees of it, by the rays of its gather: what they all
/// miss is a hole of a few degrees.
/// points   near each other, as far as that is possible: plans of gathers are shared among them.
/// One thread.
void year_at(const YearScene& scene, std::span<const PlacesOfPoint> points, const GatherPattern& pattern, RowSums& sums,
             std::span<float> total, std::span<float> direct);

}  // namespace clerestory
