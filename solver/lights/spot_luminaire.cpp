#include "solver/lights/spot_luminaire.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/model/units.h"

namespace clerestory {

Spectrum intensity(const SpotLuminaire& luminaire, const Vec3& d) {
  const double cos_outer = std::cos(luminaire.outer_angle), cos_inner = std::cos(luminaire.inner_angle);
  const double ramp =
      std::clamp((dot(d, luminaire.direction) - cos_outer) / std::max(1e-3, cos_inner - cos_outer), 0.0, 1.0);
  return luminaire.intensity * (ramp * ramp);
}

Spectrum power(const SpotLuminaire& luminaire) {
  // The ramp squared, integrated over the cosine: 1 over the inner cone, 1/3 over the width of the ramp. Of a cone so
  // narrow that the ramp does not end, what there is of it.
  const double cos_outer = std::cos(luminaire.outer_angle), cos_inner = std::cos(luminaire.inner_angle);
  const double width = std::max(1e-3, cos_inner - cos_outer), whole = 1 - cos_outer;
  const double mean = whole < width ? whole * whole * whole / (3 * width * width) : whole - width + width / 3;
  return luminaire.intensity * (2 * std::numbers::pi * mean);
}

LightBounds bounds(const SpotLuminaire& luminaire, const Vec3& position) {
  return {position, position, luminaire.direction, luminaire.outer_angle, luminous_mean(luminaire.intensity)};
}

void turn_into_image(SpotLuminaire& luminaire, const MirrorPlane& mirror) {
  luminaire.direction = mirror.image_of_direction(luminaire.direction);
}

}  // namespace clerestory
