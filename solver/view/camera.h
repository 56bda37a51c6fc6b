#pragma once
// Pictures from a point or of parallel rays: pixel -> ray, point -> pixel.

#include <optional>

#include "solver/model/vec.h"

namespace clerestory {

enum class CameraKind { perspective, orthographic, fisheye };

/// Pixels are counted from the upper left corner of the picture, x to the right and y down; (0.5, 0.5) is the middle of
/// the first.
struct Camera {
  CameraKind kind = CameraKind::perspective;
  int width = 1, height = 1;  ///< [pixel]
  Vec3 eye{};                 ///< scene's frame [m]; orthographic: the middle of the plane that rays start in
  Vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  ///< unit, at right angles
  double half_width = 1;  ///< of the picture: at distance 1 [1]; orthographic [m]; of no meaning to a fisheye
  double half_height() const { return half_width * height / width; }

  /// Looks along `forward`; `up` tells what is above as far as it can.
  /// Needs: neither zero; `up` may go along `forward`, then +y is above, or +x.
  void turn(const Vec3& forward, const Vec3& up);
};

/// A picture of an angle across its longer side, as in Blender, in (0, 180) degrees.
double half_width_of_angle(double degrees, int width, int height);

struct CameraRay {
  Vec3 origin, direction;  ///< of any length but 0
};
/// Nothing: a fisheye does not show that place.
///
/// fisheye  equidistant: the angle to `forward` grows with the distance from the middle of the picture, to 90 degrees
/// at
///          the rim of the largest circle.
std::optional<CameraRay> ray_through(const Camera& camera, double x, double y);

struct OnPicture {
  double x, y;      ///< [pixel]
  double distance;  ///< from the ray's start [m]
};
/// Nothing: it lies behind, or where a fisheye shows nothing.
std::optional<OnPicture> project(const Camera& camera, const Vec3& p);
/// The ray to p, of unit direction.
CameraRay ray_to(const Camera& camera, const Vec3& p);

}  // namespace clerestory
