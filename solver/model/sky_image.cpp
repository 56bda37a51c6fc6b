#include "solver/model/sky_image.h"

#include <algorithm>

namespace clerestory {

Spectrum horizontal_irradiance(const SkyImage& image) {
  constexpr double pi = std::numbers::pi;
  Spectrum E(0.0);
  for (std::size_t row = 0; row < image.height; ++row) {
    const auto zenith_angle = [&](std::size_t edge) {
      return std::min(pi * static_cast<double>(edge) / static_cast<double>(image.height), pi / 2);
    };
    const double upper = std::sin(zenith_angle(row)), lower = std::sin(zenith_angle(row + 1));
    Spectrum sum(0.0);
    for (std::size_t column = 0; column < image.width; ++column) sum += image.pixel(row, column);
    // A band's cos Z over its solid angle is pi (sin^2 of its lower edge - sin^2 of its upper edge).
    E += sum * (pi * (lower * lower - upper * upper) / static_cast<double>(image.width));
  }
  return E;
}

}  // namespace clerestory
