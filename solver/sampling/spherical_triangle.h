#pragma once
// Triangles on the sphere of directions.

#include <array>

#include "solver/model/vec.h"

namespace clerestory {

/// Unit directions to the corners; no two opposite.
using SphericalTriangle = std::array<Vec3, 3>;

/// Solid angle [sr], 0 to 2 pi. Source: Van Oosterom & Strackee, "The solid angle of a plane triangle", 1983.
double solid_angle(const SphericalTriangle& to);

/// A direction in a spherical triangle.
struct SphericalPoint {
  Vec3 direction;    ///< unit
  double per_share;  ///< solid angle there for each share of the unit square: that of the triangle or, where it is so
                     ///< small that it is taken as plane, close to it [sr]
};
/// Maps the unit square into a triangle of that solid angle > 0, evenly: u = 0 is corner 0, u = 1 the opposite edge.
/// Source: Arvo, "Stratified sampling of spherical triangles", 1995.
SphericalPoint point_on(const SphericalTriangle& to, double solid_angle, double u, double v);

}  // namespace clerestory
