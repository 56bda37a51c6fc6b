#pragma once
// Cameras that show a model as drawings do.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "solver/view/camera.h"

namespace clerestory {

/// From above one corner, so far that all points are in the picture.
/// points  one or more.
Camera camera_that_fits(std::span<const Vec3> points, int width, int height);

/// A plane across the model that one looks from: at `axis` (0, 1, 2 for x, y, z) = place [m].
struct Cut {
  int axis = 2;
  double place = 0;
};
/// Of what lies behind the cut: below a plane of z, with +y up; beyond one of x or y, where that is larger, with +z up.
/// Nothing where nothing does.
std::optional<Camera> camera_of_cut(const Cut& cut, std::span<const Vec3> points,
                                    std::span<const std::array<std::uint32_t, 3>> triangles, int width, int height);

}  // namespace clerestory
