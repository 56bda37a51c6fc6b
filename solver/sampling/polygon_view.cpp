#include "solver/sampling/polygon_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/geometry/polygon.h"
#include "solver/sampling/spherical_triangle.h"

namespace clerestory {
namespace {

constexpr double kSquare = 1e-6;          ///< cosine of the corners of a rectangle
constexpr double kSmallRectangle = 1e-4;  ///< [sr] below this the formula loses too many digits
}  // namespace

PolygonView::PolygonView(const Vec3& p, const Vec3& n, std::span<const std::array<Vec3, 3>> triangles,
                         std::span<const Vec3> corners) {
  const HalfSpace horizon = HalfSpace::through(p, n);
  if (corners.size() == 4 && set_rectangle(p, clip_to_front(corners, horizon, 0))) return;
  for (const auto& triangle : triangles) {
    const ClippedTriangle front = clip_to_front(triangle, horizon, 0);
    for (std::size_t k = 2; k < front.size; ++k) add(p, {front.corner[0], front.corner[k - 1], front.corner[k]});
  }
}

void PolygonView::add(const Vec3& p, std::array<Vec3, 3> corners) {
  for (Vec3& c : corners) c = normalized(c - p);
  const double omega = clerestory::solid_angle(corners);
  if (!(omega > 0)) return;
  solid_angle_ += omega;
  parts_.push_back({corners, omega, solid_angle_});
}

bool PolygonView::set_rectangle(const Vec3& p, std::span<const Vec3> corners) {
  if (corners.size() != 4) return false;
  const Vec3 ex = corners[1] - corners[0], ey = corners[3] - corners[0], d = corners[0] - p;
  const double width = length(ex), height = length(ey);
  if (!(width > 0) || !(height > 0) || std::abs(dot(ex, ey)) > kSquare * width * height ||
      length(corners[2] - corners[0] - ex - ey) > kSquare * (width + height))
    return false;
  Rectangle r{ex / width, ey / height, cross(ex / width, ey / height), 0, 0, 0, 0, 0, 0, 0, 0};
  r.z0 = dot(d, r.z);
  if (r.z0 > 0) r.z = -r.z, r.z0 = -r.z0;
  r.x0 = dot(d, r.x), r.x1 = r.x0 + width, r.y0 = dot(d, r.y), r.y1 = r.y0 + height;
  const Vec3 v00{r.x0, r.y0, r.z0}, v01{r.x0, r.y1, r.z0}, v10{r.x1, r.y0, r.z0}, v11{r.x1, r.y1, r.z0};
  const Vec3 n0 = normalized(cross(v00, v10)), n1 = normalized(cross(v10, v11)), n2 = normalized(cross(v11, v01)),
             n3 = normalized(cross(v01, v00));
  const auto corner = [](const Vec3& a, const Vec3& b) { return std::acos(std::clamp(-dot(a, b), -1.0, 1.0)); };
  r.b0 = n0.z, r.b1 = n2.z;
  r.k = 2 * std::numbers::pi - corner(n2, n3) - corner(n3, n0);
  const double omega = corner(n0, n1) + corner(n1, n2) - r.k;
  if (!(omega > kSmallRectangle)) return false;
  rectangle_ = r;
  solid_angle_ = omega;
  return true;
}

PolygonView::Sight PolygonView::look_at_rectangle(double u, double v) const {
  const Rectangle& r = rectangle_;
  const double a = u * solid_angle_ + r.k, f = (std::cos(a) * r.b0 - r.b1) / std::sin(a);
  const double c = std::clamp(std::copysign(1 / std::sqrt(f * f + r.b0 * r.b0), f), -1.0, 1.0);
  const double x = std::clamp(-c * r.z0 / std::max(1e-12, std::sqrt(1 - c * c)), r.x0, r.x1);
  const double d2 = x * x + r.z0 * r.z0;
  const double h0 = r.y0 / std::sqrt(d2 + r.y0 * r.y0), h1 = r.y1 / std::sqrt(d2 + r.y1 * r.y1);
  const double h = h0 + v * (h1 - h0), rest = 1 - h * h;
  const double y = rest > 1e-12 ? std::clamp(h * std::sqrt(d2 / rest), r.y0, r.y1) : r.y1;
  return {normalized(r.x * x + r.y * y + r.z * r.z0), solid_angle_};
}

PolygonView::Sight PolygonView::look(double u, double v) const {
  if (parts_.empty()) return look_at_rectangle(u, v);
  const double at = u * solid_angle_;
  const Part* part = &parts_.back();
  for (const Part& candidate : parts_)
    if (at < candidate.cumulative) {
      part = &candidate;
      break;
    }
  const double share = std::clamp((at - (part->cumulative - part->solid_angle)) / part->solid_angle, 0.0, 1.0);
  const SphericalPoint at_share = point_on(part->to, part->solid_angle, share, v);
  return {at_share.direction, solid_angle_ / part->solid_angle * at_share.per_share};
}

}  // namespace clerestory
