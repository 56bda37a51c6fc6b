#pragma once
// How narrowly a luminaire sends its light.

#include <array>

#include "solver/model/light_spec.h"

namespace clerestory {

/// Luminous means.
struct Beam {
  Vec3 axis;                          ///< unit, middle of the cone; zero when that is the whole sphere
  double half_angle;                  ///< of the cone that all light goes into [rad]; pi: the whole sphere
  double peak;                        ///< largest intensity [W/sr]
  double flux;                        ///< [W]
  double finest;                      ///< angle over which the intensity changes little more than linearly [rad]
  double edge_from = 4, edge_to = 4;  ///< angles from the axis between which a spot falls off, maybe sharply [rad]
  bool is_even = false;               ///< the same intensity in all directions
  double depth = 0;                   ///< half of the opening's length along the axis [m]
};
Beam beam_of(const Luminaire& luminaire);

/// Whether none of the luminaire's light can get to the triangle: its beam is no wider than a half-space, and the
/// triangle behind it, as ceilings are for most luminaires.
bool is_behind(const Luminaire& luminaire, const Beam& beam, const std::array<Vec3, 3>& corners);

/// Unit direction, uniform over the cone of the beam.
Vec3 direction_in(const Beam& beam, double u, double v);

}  // namespace clerestory
