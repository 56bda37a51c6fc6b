#pragma once
// Radiance of the sky and of the virtual ground below it.

#include "solver/model/light_spec.h"

namespace clerestory {

/// Radiance [W/(m2 sr)] from the unit direction d, seen from inside the scene; z is up.
///   above the horizon  L = Lz f(d),  scaled so that the integral of L cos(zenith angle) is the horizontal irradiance
///   below it           L = ground_reflectance / pi * (horizontal irradiance of sky and sun)
/// f = 1 (uniform, Lz = E / pi) or (1 + 2 sin(elevation)) / 3 (CIE overcast, Moon & Spencer, Lz = 9 E / (7 pi)).
class SkyRadiance {
 public:
  explicit SkyRadiance(const Lights& lights);

  bool dark() const { return !exists_; }
  Spectrum operator()(const Vec3& d) const {
    if (!exists_) return Spectrum(0.0);
    if (d.z < 0) return ground_;
    return model_ == SkyModel::uniform ? zenith_ : zenith_ * ((1 + 2 * d.z) / 3);
  }

 private:
  bool exists_ = false;
  SkyModel model_ = SkyModel::uniform;
  Spectrum zenith_, ground_;
};

}  // namespace clerestory
