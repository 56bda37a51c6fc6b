#pragma once
// The double contour integral behind unoccluded form factors, edge pair by edge pair in closed form.

#include <span>

#include "solver/model/vec.h"

namespace clerestory {

/// A sum together with what rounding may have left in it.
struct ContourSum {
  double value = 0;     ///< A1 F12 [m2]
  double rounding = 0;  ///< bound on its rounding error: machine epsilon times the sum of all terms' magnitudes [m2]
};

/// A1 F12 = 1/(2 pi) * sum_ij (u_i . u_j) int_i int_j ln r ds dt over the edges i of polygon 1 and j of polygon 2.
///
/// Needs: planar polygons, counter-clockwise around their fronts, each wholly in front of the other's plane.
/// The integral of an edge pair is closed for parallel edges and for edges whose lines meet. For skew lines at distance
/// d, with s and t measured from the lines' nearest points and r2 = s2 + t2 - 2 s t cos + d2, the divergence theorem on
/// (s, t) ln r leaves boundary terms in closed form and one bounded integral,
///   2 int int ln r = [s int ln r dt] + [t int ln r ds] - area + d2 int int ds dt / r2,
/// taken by Gauss quadrature in u = asinh(s sin / d), where the integrand is smooth at the scale of the lines' angle.
/// Sources: the contour form, Sparrow 1963; the singular end of the problem, Schroeder & Hanrahan, "On the form factor
/// between two polygons", 1993 (their dilogarithms are this last integral).
ContourSum contour_exchange(std::span<const Vec3> polygon1, std::span<const Vec3> polygon2);

/// int int ln |x - y| over the segments a0..a1 and b0..b1 by tanh-sinh quadrature of the closed inner integral, broken
/// where the integrand is singular. Slow and right for every pair; serves nearly parallel skew edges and the tests.
double segment_log_integral_by_quadrature(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

}  // namespace clerestory
