#pragma once
// Maps from the unit square to directions and points.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "solver/model/vec.h"

namespace clerestory {

/// Unit direction around frame.n with density cos / pi; polar map, so that cells of the square stay apart on the
/// hemisphere and square_of_direction() finds them again.
inline Vec3 cosine_direction(const Frame& frame, double u, double v) {
  const double r = std::sqrt(u), phi = 2 * std::numbers::pi * v;
  return frame.to_world(r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0, 1 - u)));
}

/// The (u, v) that cosine_direction() maps to `direction`, in front of the frame.
inline std::array<double, 2> square_of_direction(const Frame& frame, const Vec3& direction) {
  const double x = dot(direction, frame.t), y = dot(direction, frame.b);
  const double turn = std::atan2(y, x) / (2 * std::numbers::pi);
  return {std::min(x * x + y * y, 1 - 1e-12), turn < 0 ? std::min(turn + 1, 1 - 1e-12) : turn};
}

/// Unit direction, uniform over the sphere.
inline Vec3 sphere_direction(double u, double v) {
  const double z = 1 - 2 * u, r = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * std::numbers::pi * v;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Point of a triangle, uniform over its area. Source: Heitz, "A low-distortion map between triangle and square", 2019.
inline Vec3 point_on_triangle(const std::array<Vec3, 3>& corner, double u, double v) {
  double a = u, b = v;
  if (b > a) {
    a *= 0.5;
    b -= a;
  } else {
    b *= 0.5;
    a -= b;
  }
  return corner[0] * (1 - a - b) + corner[1] * a + corner[2] * b;
}

/// Share of the flux of a surface of radiosity 1 that arrives at a point, per area there: cos cos / (pi r2), or 0 when
/// one does not face the other.
inline double point_kernel(const Vec3& at, const Vec3& normal, const Vec3& source, const Vec3& source_normal) {
  const Vec3 d = source - at;
  const double r2 = dot(d, d), cos_at = dot(normal, d), cos_source = -dot(source_normal, d);
  return cos_at > 0 && cos_source > 0 ? cos_at * cos_source / (std::numbers::pi * r2 * r2) : 0.0;
}

}  // namespace clerestory
