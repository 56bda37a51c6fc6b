#pragma once
// Where the light of the sun's images may fall.

#include <span>

#include "solver/lights/lights.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// Whether the sun, or its image, may be seen from any point of a surface over the planes of its way; what stands
/// between is not looked at. False only where RayScene::transmittance_by_mirrors() finds nothing.
///
/// corners  1 to 4, of a convex polygon.
bool may_reach(const RayScene& rays, const PlacedSun& sun, std::span<const Vec3> corners);

}  // namespace clerestory
