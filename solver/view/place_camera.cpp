#include "solver/view/place_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/model/box.h"

namespace clerestory {
namespace {

constexpr double kAngle = 40;     // across the picture of a model from outside [degrees]
constexpr double kMargin = 1.04;  // of a picture's size over that of what it shows

/// Where a camera stands on one axis so that both edges of the picture touch the points: p - z t <= c + D t and so on.
struct Support {
  double high = -Box::kHuge, low = -Box::kHuge;
  void add(double x, double z, double t) { high = std::max(high, x / t - z), low = std::max(low, -x / t - z); }
  double place(double t) const { return t * (high - low) / 2; }
  double distance() const { return (high + low) / 2; }
};

}  // namespace

Camera camera_that_fits(std::span<const Vec3> points, int width, int height) {
  Camera camera{.width = width, .height = height};
  camera.turn({0.62, 0.83, -0.75}, {0, 0, 1});
  camera.half_width = half_width_of_angle(kAngle, width, height);
  const Vec3 centre = Box::around(points).centre();
  const double tx = camera.half_width / kMargin, ty = camera.half_height() / kMargin;
  Support across, upwards;
  double nearest = Box::kHuge;
  for (const Vec3& p : points) {
    const Vec3 d = p - centre;
    const double z = dot(d, camera.forward);
    across.add(dot(d, camera.right), z, tx), upwards.add(dot(d, camera.up), z, ty);
    nearest = std::min(nearest, z);
  }
  // In front of all, also of a single point or a line along the view.
  const double away = std::max({across.distance(), upwards.distance(), -nearest * 1.01 + 1e-3});
  camera.eye = centre + camera.right * across.place(tx) + camera.up * upwards.place(ty) - camera.forward * away;
  return camera;
}

std::optional<Camera> camera_of_cut(const Cut& cut, std::span<const Vec3> points,
                                    std::span<const std::array<std::uint32_t, 3>> triangles, int width, int height) {
  Camera camera{.kind = CameraKind::orthographic, .width = width, .height = height};
  if (cut.axis == 2) camera.turn({0, 0, -1}, {0, 1, 0});
  if (cut.axis == 1) camera.turn({0, 1, 0}, {0, 0, 1});
  if (cut.axis == 0) camera.turn({1, 0, 0}, {0, 0, 1});
  const double side = cut.axis == 2 ? -1 : 1;
  const auto depth = [&](const Vec3& p) { return side * (p[cut.axis] - cut.place); };
  Box box;
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = points[t[k]], &b = points[t[(k + 1) % 3]];
      const double da = depth(a), db = depth(b);
      if (da >= 0) box.add(a);
      if ((da < 0 && db > 0) || (da > 0 && db < 0)) box.add(a + (b - a) * (da / (da - db)));
    }
  if (!(box.lower.x <= box.upper.x)) return std::nullopt;
  const Vec3 size = box.upper - box.lower, centre = box.centre();
  const double across = std::abs(dot(size, camera.right)), upwards = std::abs(dot(size, camera.up));
  camera.half_width = kMargin * std::max(across, upwards * width / height) / 2;
  if (!(camera.half_width > 0)) return std::nullopt;
  camera.eye = centre + camera.forward * (side * cut.place - dot(centre, camera.forward));
  return camera;
}

}  // namespace clerestory
