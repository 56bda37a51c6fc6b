#pragma once
// Irradiance of a sky by plain midpoints, which know nothing of how the sky is made.

#include <cmath>
#include <functional>
#include <numbers>

#include "solver/lights/sky.h"

namespace clerestory::test {

/// Of a plane of normal n, by what is above the horizon; the error falls with the square of the steps and is below 1e-5
/// for the CIE skies.
inline double sky_irradiance(const std::function<double(const Vec3&)>& radiance, const Vec3& n) {
  constexpr int kRings = 600, kAzimuths = 800;
  constexpr double kStep = std::numbers::pi / 2 / kRings;
  double sum = 0;
  for (int i = 0; i < kRings; ++i) {
    const double Z = (i + 0.5) * kStep, area = 2 * std::sin(kStep / 2) * std::sin(Z) / kAzimuths;
    for (int j = 0; j < kAzimuths; ++j) {
      const double azimuth = 2 * std::numbers::pi * (j + 0.5) / kAzimuths;
      const Vec3 d{std::sin(Z) * std::sin(azimuth), std::sin(Z) * std::cos(azimuth), std::cos(Z)};
      sum += area * radiance(d) * std::max(0.0, dot(n, d));
    }
  }
  return 2 * std::numbers::pi * sum;
}

inline double sky_irradiance(const SkyRadiance& sky, const Vec3& n) {
  return sky_irradiance([&](const Vec3& d) { return sky(d)[0]; }, n);
}

}  // namespace clerestory::test
