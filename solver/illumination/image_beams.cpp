#include "solver/illumination/image_beams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "solver/lights/sun.h"
#include "solver/model/assert.h"

namespace clerestory {

bool may_reach(const RayScene& rays, const PlacedSun& sun, std::span<const Vec3> corners) {
  constexpr double kSpread = kSunDiameterDeg / 2 * std::numbers::pi / 180;  // of the disc [rad]
  constexpr double kRise = 4;                                               // ends of rays lie off their surfaces
  std::array<Vec3, 4> at;
  CLERESTORY_ASSERT(corners.size(), <=, at.size());
  std::ranges::copy(corners, at.begin());
  std::size_t count = corners.size();
  Vec3 d = sun.direction;
  for (std::size_t k = sun.way.count; k-- > 0;) {
    // The rectangle of this plane that the ways cross: what they come to next.
    const MirrorPlane& plane = rays.mirrors()[sun.way.plane[k]];
    const double along = dot(plane.normal, d), least = std::abs(along) - kSpread;
    if (!(least > 0)) return true;
    const double rise = kRise * rays.lift() / least;
    double farthest = -1e300;
    std::array<double, 2> low{1e300, 1e300}, high{-1e300, -1e300};
    double reach = 0;
    for (std::size_t c = 0; c < count; ++c) {
      const double distance = -plane.height(at[c]) / along;
      const Vec3 crossing = at[c] + d * distance;
      const std::array<double, 2> place{dot(plane.u, crossing), dot(plane.v, crossing)};
      for (std::size_t i = 0; i < 2; ++i) low[i] = std::min(low[i], place[i]), high[i] = std::max(high[i], place[i]);
      farthest = std::max(farthest, distance), reach = std::max(reach, std::abs(distance));
    }
    // A point in front of the plane sees another ray of the disc cross it so far from that to its centre.
    const double aside = 2 * kSpread * reach / (least * least) + rise;
    if (farthest < -aside) return false;
    for (std::size_t i = 0; i < 2; ++i) {
      low[i] = std::max(low[i] - aside, plane.low[i] - rise), high[i] = std::min(high[i] + aside, plane.high[i] + rise);
      if (low[i] > high[i]) return false;
    }
    const Vec3 foot = plane.normal * plane.offset;
    for (std::size_t c = 0; c < 4; ++c)
      at[c] = foot + plane.u * (c & 1 ? high : low)[0] + plane.v * (c & 2 ? high : low)[1];
    count = 4;
    d = plane.image_of_direction(d);
  }
  return true;
}

}  // namespace clerestory
