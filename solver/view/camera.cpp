#include "solver/view/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clerestory {
namespace {

constexpr double kHalfPi = std::numbers::pi / 2;

double radius_of_circle(const Camera& camera) { return std::min(camera.width, camera.height) / 2.0; }

OnPicture at(const Camera& camera, double across, double upwards, double distance) {
  return {(1 + across) * camera.width / 2, (1 - upwards) * camera.height / 2, distance};
}

}  // namespace

void Camera::turn(const Vec3& to, const Vec3& above) {
  forward = normalized(to);
  for (const Vec3& wish : {above, Vec3{0, 1, 0}, Vec3{1, 0, 0}}) {
    right = cross(forward, normalized(wish));
    if (length(right) > 1e-6) break;
  }
  right = normalized(right);
  up = cross(right, forward);
}

double half_width_of_angle(double degrees, int width, int height) {
  const double longer = std::tan(degrees * std::numbers::pi / 360);
  return width >= height ? longer : longer * width / height;
}

std::optional<CameraRay> ray_through(const Camera& camera, double x, double y) {
  if (camera.kind == CameraKind::fisheye) {
    const double radius = radius_of_circle(camera);
    const double across = (x - camera.width / 2.0) / radius, upwards = (camera.height / 2.0 - y) / radius;
    const double r = std::hypot(across, upwards);
    if (r > 1) return std::nullopt;
    const double theta = r * kHalfPi, s = r > 0 ? std::sin(theta) / r : kHalfPi;
    return CameraRay{camera.eye,
                     camera.forward * std::cos(theta) + camera.right * (s * across) + camera.up * (s * upwards)};
  }
  const Vec3 off = camera.right * ((2 * x / camera.width - 1) * camera.half_width) +
                   camera.up * ((1 - 2 * y / camera.height) * camera.half_height());
  if (camera.kind == CameraKind::orthographic) return CameraRay{camera.eye + off, camera.forward};
  return CameraRay{camera.eye, camera.forward + off};
}

std::optional<OnPicture> project(const Camera& camera, const Vec3& p) {
  const Vec3 d = p - camera.eye;
  const double x = dot(d, camera.right), y = dot(d, camera.up), z = dot(d, camera.forward);
  if (camera.kind == CameraKind::fisheye) {
    const double from_axis = std::hypot(x, y), theta = std::atan2(from_axis, z);
    if (!(theta <= kHalfPi)) return std::nullopt;
    const double r = from_axis > 0 ? radius_of_circle(camera) * theta / kHalfPi / from_axis : 0;
    return OnPicture{camera.width / 2.0 + r * x, camera.height / 2.0 - r * y, length(d)};
  }
  if (camera.kind == CameraKind::orthographic) {
    if (!(z >= 0)) return std::nullopt;
    return at(camera, x / camera.half_width, y / camera.half_height(), z);
  }
  if (!(z > 0)) return std::nullopt;
  return at(camera, x / (z * camera.half_width), y / (z * camera.half_height()), length(d));
}

CameraRay ray_to(const Camera& camera, const Vec3& p) {
  if (camera.kind != CameraKind::orthographic) return {camera.eye, normalized(p - camera.eye)};
  return {p - camera.forward * dot(p - camera.eye, camera.forward), camera.forward};
}

}  // namespace clerestory
