#include "solver/polygon_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/form_factors/polygon.h"

namespace clerestory {
namespace {

constexpr double kTooSmall = 1e-6;  ///< [sr] below this the formula loses too many digits

/// The part of c that is perpendicular to the unit vector a, as a unit vector.
Vec3 perpendicular(const Vec3& c, const Vec3& a) { return normalized(c - a * dot(a, c)); }

/// By Van Oosterom and Strackee, 1983.
double solid_angle_of(const std::array<Vec3, 3>& t) {
  const double volume = dot(t[0], cross(t[1] - t[0], t[2] - t[0]));
  return 2 * std::abs(std::atan2(volume, 1 + dot(t[0], t[1]) + dot(t[1], t[2]) + dot(t[2], t[0])));
}

}  // namespace

PolygonView::PolygonView(const Vec3& p, const Vec3& n, std::span<const std::array<Vec3, 3>> triangles) {
  const Plane horizon = Plane::through(p, n);
  parts_.reserve(2 * triangles.size());
  for (const auto& triangle : triangles) {
    const ClippedTriangle front = clip_to_front(triangle, horizon, 0);
    for (std::size_t k = 2; k < front.size; ++k) add(p, {front.corner[0], front.corner[k - 1], front.corner[k]});
  }
}

void PolygonView::add(const Vec3& p, std::array<Vec3, 3> corners) {
  for (Vec3& c : corners) c = normalized(c - p);
  const double omega = solid_angle_of(corners);
  if (!(omega > 0)) return;
  solid_angle_ += omega;
  parts_.push_back({corners, omega, solid_angle_});
}

PolygonView::Sight PolygonView::look(double u, double v) const {
  const double at = u * solid_angle_;
  const Part* part = &parts_.back();
  for (const Part& candidate : parts_)
    if (at < candidate.cumulative) {
      part = &candidate;
      break;
    }
  const double share = std::clamp((at - (part->cumulative - part->solid_angle)) / part->solid_angle, 0.0, 1.0);
  const auto& [a, b, c] = part->to;
  if (part->solid_angle < kTooSmall) {
    const double s = std::sqrt(share);
    const Vec3 x = a * (1 - s) + c * (s * (1 - v)) + b * (s * v);
    const double r = length(x), volume = std::abs(dot(a, cross(b - a, c - a)));  // twice the area times the height
    return {x / r, solid_angle_ / part->solid_angle * volume / (2 * r * r * r)};
  }
  // The triangle a, b, x with x on the arc from a to c that has this share of the area.
  const Vec3 ab = cross(a, b), ac = cross(a, c);
  const double scale = 1 / std::sqrt(dot(ab, ab) * dot(ac, ac));
  const double cos_alpha = dot(ab, ac) * scale, sin_alpha = length(cross(ab, ac)) * scale;  // alpha: angle at a
  const double area = share * part->solid_angle, sin_area = std::sin(area), cos_area = std::cos(area);
  const double s = sin_area * cos_alpha - cos_area * sin_alpha, t = cos_area * cos_alpha + sin_area * sin_alpha;
  const double k1 = t - cos_alpha, k2 = s + sin_alpha * dot(a, b);
  const double below = (k2 * s + k1 * t) * sin_alpha;
  const double cos_x = below != 0 ? std::clamp(((k2 * t - k1 * s) * cos_alpha - k2) / below, -1.0, 1.0) : 1.0;
  const Vec3 x = a * cos_x + perpendicular(c, a) * std::sqrt(std::max(0.0, 1 - cos_x * cos_x));
  const double cos_y = 1 - v * (1 - dot(x, b));
  return {normalized(b * cos_y + perpendicular(x, b) * std::sqrt(std::max(0.0, 1 - cos_y * cos_y))), solid_angle_};
}

}  // namespace clerestory
