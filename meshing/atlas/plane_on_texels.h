#pragma once
// Light on a triangle, that is linear there, as a function of texels.

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "meshing/atlas/raster.h"

namespace clerestory {

/// Value of a channel on a triangle: at + x grad_x + y grad_y [per texel].
struct PlaneOnTexels {
  double at = 0, grad_x = 0, grad_y = 0;
  double lowest = 0, highest = 0;  ///< at the corners
  double operator()(double x, double y) const { return at + x * grad_x + y * grad_y; }
  /// The same outside, no farther away than the corners are from each other.
  double beyond(double x, double y) const {
    return std::clamp((*this)(x, y), 2 * lowest - highest, 2 * highest - lowest);
  }
};

/// f: at the corners. Needles have no gradient.
inline PlaneOnTexels plane_of(const std::array<Texel, 3>& t, const std::array<double, 3>& f) {
  const double ux = t[1][0] - t[0][0], uy = t[1][1] - t[0][1], vx = t[2][0] - t[0][0], vy = t[2][1] - t[0][1];
  const double det = ux * vy - uy * vx;
  const double longest = std::max({std::hypot(ux, uy), std::hypot(vx, vy), std::hypot(ux - vx, uy - vy)});
  PlaneOnTexels plane;
  std::tie(plane.lowest, plane.highest) = std::minmax({f[0], f[1], f[2]});
  // Needles tell nothing across.
  if (std::abs(det) > 1e-3 * longest * longest && longest > 1e-3) {
    const double du = f[1] - f[0], dv = f[2] - f[0];
    plane.grad_x = (du * vy - dv * uy) / det;
    plane.grad_y = (dv * ux - du * vx) / det;
  }
  const double mean = (f[0] + f[1] + f[2]) / 3;
  plane.at = mean - plane.grad_x * (t[0][0] + t[1][0] + t[2][0]) / 3 - plane.grad_y * (t[0][1] + t[1][1] + t[2][1]) / 3;
  return plane;
}

}  // namespace clerestory
