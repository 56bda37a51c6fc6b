#pragma once
// Lines on surfaces, as far as a camera sees them.

#include <span>
#include <vector>

#include "solver/view/camera.h"
#include "solver/visibility/seen_surfaces.h"

namespace clerestory {

/// The parts of a line that are seen, in steps of two pixels at most; each with two or more points.
///
/// line  on triangles of `surfaces` that face the camera, without those behind it: facing_triangles().
/// Cost: a ray for each two pixels.
std::vector<std::vector<OnPicture>> visible_parts(const Camera& camera, const SeenSurfaces& surfaces,
                                                  std::span<const Vec3> line);

/// Those that the camera looks at from where their corners run counter-clockwise.
std::vector<std::array<std::uint32_t, 3>> facing_triangles(const Camera& camera, std::span<const Vec3> points,
                                                           std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace clerestory
