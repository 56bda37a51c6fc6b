#pragma once
// Luminaires without extent.

#include <algorithm>
#include <cmath>

#include "solver/lights/web_luminaire.h"
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

/// What lamps with an opening have too, see web_luminaire.h.
template <class Lamp>
double reach(const Lamp&) {
  return 0;
}
template <class Lamp>
int opening_rays(const Lamp&, const Vec3&) {
  return 1;
}
template <class Lamp>
OpeningPlace opening_place(const Lamp&, int, int) {
  return {};
}
template <class Lamp>
Vec3 light_point(const Lamp& lamp, const Vec3&, double, double) {
  return lamp.position;
}

/// What r2 counts as at least [m2].
template <class Lamp>
double least_r2(const Lamp&) {
  return 0;
}

/// Irradiance [W/m2] at point p with unit normal n from the lamp's point q, when nothing blocks: I cos / r2. The mean
/// over the points q of an opening is what it gives: each sends the lamp's intensity, so the flux is the lamp's
/// whatever the distance.
template <class Lamp>
Spectrum open_irradiance(const Lamp& lamp, const Vec3& q, const Vec3& p, const Vec3& n) {
  const Vec3 to_lamp = q - p;
  const double r2 = dot(to_lamp, to_lamp), r = std::sqrt(r2), cos_r = dot(n, to_lamp);
  if (!(cos_r > 0)) return Spectrum(0.0);
  return intensity(lamp, to_lamp / -r) * (cos_r / (std::max(r2, least_r2(lamp)) * r));
}
/// The same from the lamp's middle.
template <class Lamp>
Spectrum open_irradiance(const Lamp& lamp, const Vec3& p, const Vec3& n) {
  return open_irradiance(lamp, lamp.position, p, n);
}

/// End of the shadow ray from p to q on a lamp: short of it by a hair, as lamps hang in the very plane of a ceiling.
inline Vec3 short_of(const Vec3& q, const Vec3& p, double lift) {
  const Vec3 back = p - q;
  const double r = length(back);
  return r > 0 ? q + back * std::min(0.5, 20 * lift / r) : q;
}

}  // namespace clerestory
