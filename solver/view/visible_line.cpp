#include "solver/view/visible_line.h"

#include <algorithm>
#include <cmath>

namespace clerestory {
namespace {

constexpr double kStep = 2;              // between rays along a line [pixel]
constexpr double kMostSteps = 4096;      // of one straight piece
constexpr double kStepsFromBehind = 64;  // of one that comes from behind the camera
constexpr double kAtPlace = 5e-4;        // of the distance: so near to where a ray ends, a point is what it meets

bool is_in_picture(const Camera& camera, const OnPicture& at) {
  return at.x >= -kStep && at.y >= -kStep && at.x <= camera.width + kStep && at.y <= camera.height + kStep;
}

}  // namespace

std::vector<std::vector<OnPicture>> visible_parts(const Camera& camera, const SeenSurfaces& surfaces,
                                                  std::span<const Vec3> line) {
  std::vector<std::vector<OnPicture>> parts;
  std::vector<OnPicture> part;
  const auto end_part = [&] {
    if (part.size() > 1) parts.push_back(part);
    part.clear();
  };
  const auto look_at = [&](const Vec3& p) {
    const auto at = project(camera, p);
    bool is_seen = at && is_in_picture(camera, *at);
    if (is_seen) {
      const CameraRay ray = ray_to(camera, p);
      const double met = surfaces.distance(ray.origin, ray.direction);
      is_seen = std::abs(met - at->distance) <= kAtPlace * at->distance + 4 * surfaces.lift();
    }
    if (is_seen)
      part.push_back(*at);
    else
      end_part();
  };
  for (std::size_t k = 0; k < line.size(); ++k) {
    look_at(line[k]);
    if (k + 1 == line.size()) break;
    const auto a = project(camera, line[k]), b = project(camera, line[k + 1]);
    const double steps = a && b ? std::hypot(b->x - a->x, b->y - a->y) / kStep : kStepsFromBehind;
    const auto n = static_cast<int>(std::ceil(std::min(steps, kMostSteps)));
    for (int i = 1; i < n; ++i) look_at(line[k] + (line[k + 1] - line[k]) * (static_cast<double>(i) / n));
  }
  end_part();
  return parts;
}

std::vector<std::array<std::uint32_t, 3>> facing_triangles(const Camera& camera, std::span<const Vec3> points,
                                                           std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::vector<std::array<std::uint32_t, 3>> facing;
  for (const auto& t : triangles) {
    const Vec3 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    const Vec3 along = camera.kind == CameraKind::orthographic ? camera.forward : a - camera.eye;
    if (dot(cross(b - a, c - a), along) < 0) facing.push_back(t);
  }
  return facing;
}

}  // namespace clerestory
