#include "solver/lights/sun.h"

#include <cmath>
#include <numbers>

namespace clerestory {
namespace {

// sin(a)^2 and not 1 - cos(a): the disc is small and the difference would lose digits.
double sin_half_disc() {
  static const double sine = std::sin(kSunDiameterDeg / 2 * std::numbers::pi / 180);
  return sine;
}

}  // namespace

Vec3 direction_to_sun(const Sun& sun, double u, double v) {
  const double sin_half = sin_half_disc();
  const double r = sin_half * std::sqrt(u), phi = 2 * std::numbers::pi * v;
  return Frame(sun.direction).to_world(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r));
}

double density_in_disc(const Sun& sun, const Vec3& d) {
  return dot(d, sun.direction) / (std::numbers::pi * sin_half_disc() * sin_half_disc());
}

}  // namespace clerestory
