#include "solver/visibility/mirror_planes.h"

#include <algorithm>
#include <cmath>

namespace clerestory {

MirrorPlane mirror_plane(const Vec3& normal, double offset, bool is_glass) {
  MirrorPlane plane{normal, offset, is_glass, {}, {}};
  // Panes stand upright or lie: the rectangle's sides are level and plumb.
  const Vec3 up = std::abs(normal.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
  plane.u = normalized(cross(up, normal));
  plane.v = cross(normal, plane.u);
  return plane;
}

void MirrorPlane::add(const Vec3& x) {
  const std::array<double, 2> at{dot(u, x), dot(v, x)};
  for (std::size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
}

bool MirrorPlane::is_over(const Vec3& p, const Vec3& n) const {
  const Vec3 foot = normal * offset;
  for (const double a : {low[0], high[0]})
    for (const double b : {low[1], high[1]})
      if (dot(n, foot + u * a + v * b - p) > 0) return true;
  return false;
}

bool MirrorPlane::is_within(const Vec3& x, double margin) const {
  const double a = dot(u, x), b = dot(v, x);
  return a >= low[0] - margin && a <= high[0] + margin && b >= low[1] - margin && b <= high[1] + margin;
}

}  // namespace clerestory
