#pragma once
// Direct sun at points, by the hour: shadow rays to its disc where it stands then.

#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/point_irradiance.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// The sun in an hour, and where rays to it go.
struct SunOfHour {
  Vec3 direction;                  ///< unit, scene's frame
  std::vector<MirrorWay> ways;     ///< over which mirrors and panes it may come, too
  std::vector<Vec3> pilots, more;  ///< unit, to points of its disc: `more` where the pilots disagree

  /// Pilots stand at the disc's rim, above, below and on both sides: edges that are level or plumb never pass between
  /// them and the sky unseen, others where they cut off less than 9 % of the disc.
  /// key  of the hour. rays: of `more`; 0: pilots alone.
  SunOfHour(const Vec3& to_sun, std::vector<MirrorWay> over, std::size_t rays, std::uint64_t key);
};

/// Illuminance at points over that of a plane which faces the sun, as a luminous mean [1]: share of the disc that is
/// seen, what glass lets pass, cosine.
///
/// points    places, lifted, and unit normals.
/// may_come  points x suns by point, or empty: false where no sun needs to be looked for.
/// out       points x suns, by point; replaced.
/// One thread. Cost: four rays a point and hour with the sun in front of it.
void sun_on_points(const RayScene& rays, std::span<const ReceivingPoint> points, std::span<const SunOfHour> suns,
                   const std::vector<bool>& may_come, std::span<float> out);

}  // namespace clerestory
