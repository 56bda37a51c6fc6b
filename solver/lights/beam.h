#pragma once
// How narrowly a luminaire sends its light.

#include "solver/model/light_spec.h"

namespace clerestory {

/// Luminous means.
struct Beam {
  Vec3 axis;             ///< unit, middle of the cone; zero when that is the whole sphere
  double half_angle;     ///< of the cone that all light goes into [rad]; pi: the whole sphere
  double peak;           ///< largest intensity [W/sr]
  double flux;           ///< [W]
  double finest;         ///< angle over which the intensity changes little more than linearly [rad]
  bool is_even = false;  ///< the same intensity in all directions
};
Beam beam_of(const Luminaire& luminaire);

/// Unit direction, uniform over the cone of the beam.
Vec3 direction_in(const Beam& beam, double u, double v);

}  // namespace clerestory
