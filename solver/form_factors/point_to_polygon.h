#pragma once
// What a point sees of a polygon, in closed form.

#include <span>

#include "solver/model/vec.h"

namespace clerestory {

/// Form factor [1] from a surface element at p with unit normal n to an unoccluded planar polygon, by Lambert's contour
/// sum over the part above p's horizon:
///   F = 1/(2 pi) * sum_k theta_k * dot(n, cross(b_k, a_k)) / |cross(b_k, a_k)|,   a_k, b_k: p to the ends of edge k.
/// The polygon may be non-convex; it acts on its front, so F = 0 from behind it or in its plane. Relative error about
/// 1e-13 * distance / size. Source: Lambert, "Photometria", 1760; Howell's catalogue of configuration factors, C-1.
double point_to_polygon(const Vec3& p, const Vec3& n, std::span<const Vec3> polygon);

}  // namespace clerestory
