#pragma once
// Where a path goes on from a point, and with which density.

#include <array>

#include "solver/illumination/illumination.h"
#include "solver/model/random_stream.h"

namespace clerestory {

/// A path is not ended while it carries more than this of what it started with. Measured: variance times time is least
/// from 0.2 to 0.4, a sixth of that at 1 in a room of reflectance 0.5.
inline constexpr double kSafe = 0.3;
/// What the choice of an opening and the ray through it cost, in rays.
inline constexpr unsigned kCostOfOpening = 3;

/// Mostly in proportion to the cosine; where there are slits, half of the paths through one of them: others find them
/// once in a thousand times. Either way counts by its share of both densities.
struct WayOn {
  Vec3 direction;
  double density = 0;  ///< of both together [1/sr]
  double factor = 1;   ///< of its light; 0: nowhere
  bool by_slit = false;
};

/// From point p with normal n: the unit square chooses the direction.
WayOn way_on(const Illumination& light, const Vec3& p, const Vec3& n, const std::array<double, 2>& square,
             RandomStream& random);

/// WayOn::density of the unit direction d.
double density_of_ways(const Illumination& light, const Vec3& p, const Vec3& n, const Vec3& d);

}  // namespace clerestory
