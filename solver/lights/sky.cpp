#include "solver/lights/sky.h"

#include <algorithm>
#include <numbers>

namespace clerestory {

SkyRadiance::SkyRadiance(const Lights& lights, double scale) {
  if (!lights.sky) return;
  constexpr double pi = std::numbers::pi;
  const Sky& sky = *lights.sky;
  exists_ = true;
  switch (sky.model) {
    case SkyModel::uniform:
      kind_ = Kind::uniform;
      zenith_ = sky.horizontal_irradiance / pi;
      break;
    case SkyModel::cie_overcast:
      kind_ = Kind::overcast;
      zenith_ = sky.horizontal_irradiance * (9 / (7 * pi));
      break;
    case SkyModel::image:
      kind_ = Kind::image;
      image_ = sky.image;
      image_has_ground_ = sky.image_has_ground;
      image_scale_ = scale;
      break;
    case SkyModel::mean:
      kind_ = Kind::mean;
      for (const Sky& part : sky.parts) {
        Lights alone;
        alone.sky = part;
        if (!part.horizontal_irradiance.is_black())
          parts_.emplace_back(alone, scale / static_cast<double>(sky.parts.size()));
      }
      break;
    case SkyModel::cie_clear:
    case SkyModel::cie_general:
    case SkyModel::perez:
      kind_ = Kind::shaped;
      shape_ = SkyShapeTable(sky.shape, sky.sun);
      zenith_ = sky.horizontal_irradiance / horizontal_integral(sky.shape, std::asin(std::clamp(sky.sun.z, -1.0, 1.0)));
      break;
  }
  Spectrum horizontal = sky.horizontal_irradiance;
  for (const PlacedSun& sun : lights.suns)
    if (!sun.is_image()) horizontal += sun.normal_irradiance * std::max(0.0, sun.direction.z);
  zenith_ *= scale;
  ground_ = horizontal * (scale * sky.ground_reflectance / pi);
}

}  // namespace clerestory
