#pragma once
// What draft, standard and fine stand for: the one table in which accuracy becomes numbers.

#include <cstddef>

#include "solver/evaluate/measured_error.h"
#include "solver/illumination/direct.h"
#include "solver/model/method.h"
#include "solver/sampling/gather_pattern.h"

namespace clerestory {

/// The same of a year of daylight.
struct YearEffort {
  std::size_t sky_parts;  ///< that points see straight, one of kSkyPartCounts
  double node_step_deg;   ///< between positions of the sun whose light surfaces send on
  std::size_t sun_rays;   ///< to the disc, where a point lies in half-shadow
  // Measured error of single hours.
  std::size_t error_hours, error_points;  ///< points in each hour, other ones in every hour
  int error_paths;                        ///< a point, before those that are noisy get more
  int error_sun_rays;
};

/// What a solve spends and tolerates.
struct Effort {
  // Triangles to aim for when no longest edge is given; few where elements are halved later.
  double triangles_to_halve;  ///< `hierarchical`
  double triangles;           ///< the other methods

  // Hierarchical.
  int bundle_rays, bright_rays;  ///< from each receiver, see LinkOptions
  double element_tolerance;      ///< of the irradiance within an element [1]
  double vertex_tolerance;       ///< of the irradiance between vertices [1]
  double shortest_edge;          ///< / longest edge: below it nothing is halved [1]
  std::size_t most_points;       ///< gathered

  // Caustics.
  double caustic_particles;  ///< sent at all that shows no image of a light
  double caustic_legs;       ///< that tell the irradiance at a point

  // Final gathers.
  GatherQuality vertices, sensors;
  bool gathers_vertices;  ///< of the other methods; else vertices are means of their elements

  // The other methods.
  DirectOptions direct;  ///< seed apart
  int closure_rays;
  double stop_fraction;  ///< unshot / emitted flux [1]
  double rays_per_patch;
  GatherQuality noisy_patches;  ///< of patches that few rays of a shot met
  int paths, paths_of_sensor;   ///< from each patch and vertex; from each sensor
  double particles;             ///< sent for each patch

  ErrorEffort error;
  YearEffort year;
};

/// tighten  times that the effort was raised to reach a target error: each time twice the rays, and tolerances that
///          suit elements of half the area.
Effort effort(Accuracy accuracy, int tighten = 0);

/// A round that tightens has edges so much shorter: elements of half the area.
inline constexpr double kTighterEdge = 0.70710678118654752;

}  // namespace clerestory
