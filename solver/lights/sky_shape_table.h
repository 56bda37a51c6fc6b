#pragma once
// A sky's shape, fast: rays that leave the scene ask for it by the million.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "solver/model/sky_shape.h"
#include "solver/model/vec.h"

namespace clerestory {

/// Integral [sr] of L cos Z over the sky above the horizon, for a sun at `elevation` [rad]; 1e-7 relative.
double horizontal_integral(const SkyShape& shape, double elevation);

/// phi(Z) f(chi) of a shape from tables, linear between entries: relative error below 1e-6 for the CIE skies, 5e-5 for
/// Perez'. 40 KB.
class SkyShapeTable {
 public:
  SkyShapeTable() = default;
  /// sun  unit, to the sun.
  SkyShapeTable(const SkyShape& shape, const Vec3& sun);

  /// Of the unit direction d, d.z >= 0.
  double operator()(const Vec3& d) const {
    const double phi = look_up(gradation_, std::sqrt(d.z));
    const double cos_chi = dot(d, sun_);
    // Half angles, from the nearer of the two ends: the angle is smooth in their sine, and in the cosine it is not.
    return phi * (cos_chi > 0 ? look_up(near_, std::sqrt(std::max(0.0, 0.5 - 0.5 * cos_chi)))
                              : look_up(far_, std::sqrt(std::max(0.0, 0.5 + 0.5 * cos_chi))));
  }

 private:
  static constexpr std::size_t kSteps = 4096;  ///< from argument 0 to 1
  using Table = std::vector<float>;
  static double look_up(const Table& table, double x) {
    const double place = x * kSteps;
    const auto i = static_cast<std::size_t>(place);
    const double below = table[i], above = table[i + 1];
    return below + (place - static_cast<double>(i)) * (above - below);
  }

  Vec3 sun_;
  Table gradation_;   ///< over sqrt(cos Z), which is dense at the horizon
  Table near_, far_;  ///< over sin(chi / 2) and cos(chi / 2), up to sqrt(1/2)
};

}  // namespace clerestory
