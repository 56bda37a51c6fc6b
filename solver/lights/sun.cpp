#include "solver/lights/sun.h"

#include <cmath>
#include <numbers>

namespace clerestory {

Vec3 direction_to_sun(const Sun& sun, double u, double v) {
  // sin(a)^2 and not 1 - cos(a): the disc is small and the difference would lose digits.
  static const double sin_half = std::sin(kSunDiameterDeg / 2 * std::numbers::pi / 180);
  const double r = sin_half * std::sqrt(u), phi = 2 * std::numbers::pi * v;
  return Frame(sun.direction).to_world(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r));
}

}  // namespace clerestory
