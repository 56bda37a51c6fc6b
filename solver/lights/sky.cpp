#include "solver/lights/sky.h"

#include <algorithm>
#include <numbers>

namespace clerestory {

SkyRadiance::SkyRadiance(const Lights& lights) {
  if (!lights.sky) return;
  constexpr double pi = std::numbers::pi;
  const Sky& sky = *lights.sky;
  exists_ = true;
  model_ = sky.model;
  zenith_ = sky.horizontal_irradiance * (model_ == SkyModel::uniform ? 1 / pi : 9 / (7 * pi));
  Spectrum horizontal = sky.horizontal_irradiance;
  for (const Sun& sun : lights.suns) horizontal += sun.normal_irradiance * std::max(0.0, sun.direction.z);
  ground_ = horizontal * (sky.ground_reflectance / pi);
}

}  // namespace clerestory
