#include "solver/lights/spot_luminaire.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/model/units.h"

namespace clerestory {

Spectrum intensity(const SpotLuminaire& lamp, const Vec3& d) {
  const double cos_outer = std::cos(lamp.outer_angle), cos_inner = std::cos(lamp.inner_angle);
  const double ramp =
      std::clamp((dot(d, lamp.direction) - cos_outer) / std::max(1e-3, cos_inner - cos_outer), 0.0, 1.0);
  return lamp.intensity * (ramp * ramp);
}

Spectrum power(const SpotLuminaire& lamp) {
  // The ramp squared, integrated over the cosine: 1 over the inner cone, 1/3 over the width of the ramp.
  const double cos_outer = std::cos(lamp.outer_angle), cos_inner = std::cos(lamp.inner_angle);
  const double width = std::max(1e-3, cos_inner - cos_outer), full_from = cos_outer + width;
  return lamp.intensity * (2 * std::numbers::pi * (1 - full_from + width / 3));
}

LightBounds bounds(const SpotLuminaire& lamp, const Vec3& position) {
  return {position, position, lamp.direction, lamp.outer_angle, luminous_mean(lamp.intensity)};
}

void turn_into_image(SpotLuminaire& lamp, const MirrorPlane& mirror) {
  lamp.direction = mirror.image_of_direction(lamp.direction);
}

}  // namespace clerestory
