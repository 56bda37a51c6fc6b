#include "solver/sampling/spherical_triangle.h"

#include <algorithm>
#include <cmath>

namespace clerestory {
namespace {

constexpr double kTooSmall = 1e-6;  ///< [sr] below this the formula loses too many digits

/// The part of c that is perpendicular to the unit vector a, as a unit vector.
Vec3 perpendicular(const Vec3& c, const Vec3& a) { return normalized(c - a * dot(a, c)); }

double volume(const SphericalTriangle& t) { return dot(t[0], cross(t[1] - t[0], t[2] - t[0])); }

}  // namespace

double solid_angle(const SphericalTriangle& t) {
  return 2 * std::abs(std::atan2(volume(t), 1 + dot(t[0], t[1]) + dot(t[1], t[2]) + dot(t[2], t[0])));
}

SphericalPoint point_on(const SphericalTriangle& to, double solid_angle, double u, double v) {
  const auto& [a, b, c] = to;
  if (solid_angle < kTooSmall) {
    const double s = std::sqrt(u);
    const Vec3 x = a * (1 - s) + c * (s * (1 - v)) + b * (s * v);
    const double r = length(x);
    return {x / r, std::abs(volume(to)) / (2 * r * r * r)};  // the volume is twice the area times the height
  }
  // The triangle a, b, x with x on the arc from a to c that has this share of the area.
  const Vec3 ab = cross(a, b), ac = cross(a, c);
  const double scale = 1 / std::sqrt(dot(ab, ab) * dot(ac, ac));
  const double cos_alpha = dot(ab, ac) * scale, sin_alpha = length(cross(ab, ac)) * scale;  // alpha: angle at a
  const double area = u * solid_angle, sin_area = std::sin(area), cos_area = std::cos(area);
  const double s = sin_area * cos_alpha - cos_area * sin_alpha, t = cos_area * cos_alpha + sin_area * sin_alpha;
  const double k1 = t - cos_alpha, k2 = s + sin_alpha * dot(a, b);
  const double below = (k2 * s + k1 * t) * sin_alpha;
  const double cos_x = below != 0 ? std::clamp(((k2 * t - k1 * s) * cos_alpha - k2) / below, -1.0, 1.0) : 1.0;
  const Vec3 x = a * cos_x + perpendicular(c, a) * std::sqrt(std::max(0.0, 1 - cos_x * cos_x));
  const double cos_y = 1 - v * (1 - dot(x, b));
  return {normalized(b * cos_y + perpendicular(x, b) * std::sqrt(std::max(0.0, 1 - cos_y * cos_y))), solid_angle};
}

}  // namespace clerestory
