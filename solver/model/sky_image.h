#pragma once
// A picture of all directions around a point.

#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <vector>

#include "solver/model/channels.h"
#include "solver/model/vec.h"

namespace clerestory {

/// Equirectangular: rows from the zenith down to the nadir, columns clockwise (north, east, south, west as one looks
/// from inside), the middle column at `middle_deg`. A pixel has one radiance all over, so that its sum is exact.
struct SkyImage {
  std::size_t width = 0, height = 0;
  double middle_deg = 0;     ///< of the middle column, clockwise from +y [degrees]
  std::vector<float> value;  ///< 3 * (row * width + column) + channel [W/(m2 sr)]

  Spectrum pixel(std::size_t row, std::size_t column) const {
    const float* p = &value[3 * (row * width + column)];
    return {p[0], p[1], p[2]};
  }
  /// Of the unit direction d, z up.
  Spectrum radiance(const Vec3& d) const {
    constexpr double pi = std::numbers::pi;
    double turn = (std::atan2(d.x, d.y) - middle_deg * pi / 180) / (2 * pi) + 0.5;
    turn -= std::floor(turn);
    const double down = std::atan2(std::hypot(d.x, d.y), d.z) / pi;
    const auto index = [](double share, std::size_t n) {
      const auto i = static_cast<std::size_t>(share * static_cast<double>(n));
      return i < n ? i : n - 1;
    };
    return pixel(index(down, height), index(turn, width));
  }
  bool is_grey() const {
    for (std::size_t i = 0; i < value.size(); i += 3)
      if (value[i] != value[i + 1] || value[i] != value[i + 2]) return false;
    return true;
  }
};

/// Irradiance [W/m2] of an upward plane by what is above the horizon.
Spectrum horizontal_irradiance(const SkyImage& image);

}  // namespace clerestory
