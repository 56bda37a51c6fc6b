#pragma once
// Unoccluded exchange between two triangles, fast: for the millions of pairs of a full matrix.

#include <array>

#include "solver/form_factors/triangle_quadrature.h"
#include "solver/model/vec.h"

namespace clerestory {

/// A triangle with everything the quadrature rules need of it, made once and used in N pairs.
struct QuadratureTriangle {
  std::array<Vec3, 3> corner;  ///< counter-clockwise around the front
  Vec3 normal;                 ///< unit
  double offset = 0;           ///< of its plane, dot(normal, x) = offset
  double area = 0;             ///< [m2]
  Vec3 centre;
  double radius = 0;  ///< of the sphere around the centre that holds the corners [m]
  TrianglePoints<3> points3;
  TrianglePoints<6> points6;
  TrianglePoints<12> points12;

  explicit QuadratureTriangle(const std::array<Vec3, 3>& corners);
};

/// Exchange area A_a F_ab [m2], symmetric, relative error about 1e-4 at worst and mostly below 1e-5 (a pair that is cut
/// by the other's horizon is clipped first). Far pairs take a product rule of 3, 6 or 12 points on each side, by their
/// distance against their size, near and touching ones the contour integral of contour_exchange.h: 0.05 to 5 us.
double triangle_exchange(const QuadratureTriangle& a, const QuadratureTriangle& b);

}  // namespace clerestory
