#pragma once
// Luminaires nearer to a surface than rays in float can tell: the side is decided in double, and rays keep clear.

#include "solver/lights/lights.h"

namespace clerestory {

/// Both ends of a shadow ray between a point of a luminaire and a receiver.
struct ShadowSegment {
  Vec3 from;     ///< at the receiver
  Vec3 to;       ///< at the luminaire
  bool is_free;  ///< so short that nothing but the planes could be between them
};

/// From `from` (lifted off its surface) to point q of the luminaire. Both ends are moved to a clearance of the near
/// planes, each on its own side; in a plane that the luminaire is mounted in, q goes to the receiver's side.
ShadowSegment shadow_segment(const PlacedLuminaire& luminaire, const Vec3& q, const Vec3& from);

/// Where a ray from q in direction d (unit) starts: clear of the near planes.
Vec3 ray_start(const PlacedLuminaire& luminaire, const Vec3& q, const Vec3& d);

/// Whether the luminaire is mounted in the plane through x: of normal n, unit.
bool is_mounted_in(const PlacedLuminaire& luminaire, const Vec3& x, const Vec3& n);

}  // namespace clerestory
