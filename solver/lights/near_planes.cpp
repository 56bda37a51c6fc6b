#include "solver/lights/near_planes.h"

#include <algorithm>
#include <cmath>

namespace clerestory {
namespace {

/// Moves x off the planes that it is nearer to than their clearance. side_in: its side of planes that hold the
/// luminaire, by height of another point; null: its own.
Vec3 clear_of(const std::vector<NearPlane>& planes, Vec3 x, const Vec3* side_in) {
  // Twice: what one plane of a corner moves may bring the other nearer again.
  for (int pass = 0; pass < 2; ++pass)
    for (const NearPlane& plane : planes) {
      const double own = plane.height(x), height = plane.is_mount && side_in ? plane.height(*side_in) : own;
      const double at = std::copysign(plane.clearance, height);
      if (std::abs(own) < plane.clearance) x += plane.normal * (at - own);
    }
  return x;
}

}  // namespace

ShadowSegment shadow_segment(const PlacedLuminaire& luminaire, const Vec3& q, const Vec3& from) {
  if (luminaire.near_planes.empty()) return {from, q, false};
  const Vec3 a = clear_of(luminaire.near_planes, from, nullptr), b = clear_of(luminaire.near_planes, q, &from);
  double clearance = luminaire.near_planes.front().clearance;
  for (const NearPlane& plane : luminaire.near_planes) clearance = std::min(clearance, plane.clearance);
  return {a, b, !luminaire.is_image() && length(b - a) < clearance};
}

Vec3 ray_start(const PlacedLuminaire& luminaire, const Vec3& q, const Vec3& d) {
  if (luminaire.near_planes.empty()) return q;
  const Vec3 ahead = q + d;
  return clear_of(luminaire.near_planes, q, &ahead);
}

bool is_mounted_in(const PlacedLuminaire& luminaire, const Vec3& x, const Vec3& n) {
  return std::ranges::any_of(luminaire.near_planes, [&](const NearPlane& plane) {
    return plane.is_mount && std::abs(dot(plane.normal, n)) > 1 - 1e-9 && std::abs(plane.height(x)) < plane.clearance;
  });
}

}  // namespace clerestory
