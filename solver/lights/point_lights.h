#pragma once
// Luminaires without extent.

#include "solver/model/light_spec.h"

namespace clerestory {

/// Intensity [W/sr] towards the unit direction d.
Spectrum intensity(const PointLuminaire& lamp, const Vec3& d);
/// Intensity of a spot: full inside the inner cone, none outside the outer one, between them as glTF
/// KHR_lights_punctual says: the square of a ramp in the cosine.
Spectrum intensity(const SpotLuminaire& lamp, const Vec3& d);

/// Total flux [W].
Spectrum power(const PointLuminaire& lamp);
Spectrum power(const SpotLuminaire& lamp);

/// Irradiance [W/m2] at point p with unit normal n, when nothing blocks: I cos / r2.
template <class Lamp>
Spectrum open_irradiance(const Lamp& lamp, const Vec3& p, const Vec3& n) {
  const Vec3 to_lamp = lamp.position - p;
  const double r2 = dot(to_lamp, to_lamp), r = std::sqrt(r2), cos_r = dot(n, to_lamp);
  if (!(cos_r > 0)) return Spectrum(0.0);
  return intensity(lamp, to_lamp / -r) * (cos_r / (r2 * r));
}

}  // namespace clerestory
