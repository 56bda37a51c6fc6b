#pragma once
// Radiance of the sky and of the virtual ground below it.

#include <memory>
#include <vector>

#include "solver/lights/lights.h"
#include "solver/lights/sky_shape_table.h"

namespace clerestory {

/// Radiance [W/(m2 sr)] from the unit direction d, seen from inside the scene; z is up.
///   above the horizon  L = Lz f(d),  scaled so that the integral of L cos(zenith angle) is the horizontal irradiance
///   below it           L = ground_reflectance / pi * (horizontal irradiance of sky and sun)
/// f = 1 (uniform, Lz = E / pi), (1 + 2 sin(elevation)) / 3 (CIE overcast, Moon & Spencer, Lz = 9 E / (7 pi)), or
/// the sky's shape, whose integral is taken by quadrature when this is made (2 ms). An image is shown as it is. The
/// mean of several skies is that of their radiances. Thread safe. A look-up takes 1 to 15 ns, of a mean as long as of
/// all its parts.
class SkyRadiance {
 public:
  /// scale  of all of it [1].
  explicit SkyRadiance(const Lights& lights, double scale = 1);

  bool dark() const { return !exists_; }
  Spectrum operator()(const Vec3& d) const {
    if (!exists_) return Spectrum(0.0);
    if (d.z < 0 && !image_has_ground_) return ground_;
    switch (kind_) {
      case Kind::uniform:
        return zenith_;
      case Kind::overcast:
        return zenith_ * ((1 + 2 * d.z) / 3);
      case Kind::shaped:
        return zenith_ * shape_(d);
      case Kind::image:
        return image_->radiance(d) * image_scale_;
      case Kind::mean: {
        Spectrum sum(0.0);
        for (const SkyRadiance& part : parts_) sum += part(d);
        return sum;
      }
    }
    return Spectrum(0.0);
  }

 private:
  enum class Kind { uniform, overcast, shaped, image, mean };

  bool exists_ = false, image_has_ground_ = false;
  Kind kind_ = Kind::uniform;
  Spectrum zenith_;  ///< factor of f; the radiance at the zenith where f is 1 there
  Spectrum ground_;
  SkyShapeTable shape_;
  std::shared_ptr<const SkyImage> image_;
  double image_scale_ = 1;
  std::vector<SkyRadiance> parts_;  ///< that sum to a mean
};

}  // namespace clerestory
