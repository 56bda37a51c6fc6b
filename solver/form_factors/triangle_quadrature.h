#pragma once
// Quadrature of the kernel cos cos / (pi r2) over two triangles: for pairs that are far apart against their size.

#include <array>
#include <cstddef>
#include <numbers>

#include "solver/model/vec.h"

namespace clerestory {

/// Points and weights of a rule on a triangle; the weights sum to 1. Points as separate coordinates, for the kernel.
template <std::size_t Points>
struct TrianglePoints {
  std::array<double, Points> x, y, z;
};
template <std::size_t Points>
struct TriangleRule {
  std::array<double, Points> b0, b1, b2;  ///< barycentric coordinates
  std::array<double, Points> weight;

  TrianglePoints<Points> on(const std::array<Vec3, 3>& c) const {
    TrianglePoints<Points> p;
    for (std::size_t k = 0; k < Points; ++k) {
      p.x[k] = b0[k] * c[0].x + b1[k] * c[1].x + b2[k] * c[2].x;
      p.y[k] = b0[k] * c[0].y + b1[k] * c[1].y + b2[k] * c[2].y;
      p.z[k] = b0[k] * c[0].z + b1[k] * c[1].z + b2[k] * c[2].z;
    }
    return p;
  }
};

/// Symmetric rules with 3, 6 and 12 points, exact for polynomials of degree 2, 4 and 6.
/// Source: Dunavant, "High degree efficient symmetrical Gaussian quadrature rules for the triangle", 1985.
const TriangleRule<3>& triangle_rule_3();
const TriangleRule<6>& triangle_rule_6();
const TriangleRule<12>& triangle_rule_12();
/// 36 points, exact for degree 10: a 6 x 6 Gauss-Legendre product, one side of the square collapsed to a corner.
const TriangleRule<36>& triangle_rule_36();

/// sum_ij w_i w_j h_b(x_i) h_a(y_j) / (pi r^4) over points x of triangle a and y of triangle b, where h_a(y) =
/// n_a . (y - x) is y's height over a's plane, whichever x: this is the mean of cos cos / (pi r2), F_ab = A_b * mean.
template <std::size_t Points>
double mean_kernel(const TriangleRule<Points>& rule, const TrianglePoints<Points>& a, const Vec3& normal_a,
                   double offset_a, const TrianglePoints<Points>& b, const Vec3& normal_b, double offset_b) {
  std::array<double, Points> over_a;
  for (std::size_t j = 0; j < Points; ++j)
    over_a[j] = rule.weight[j] * (normal_a.x * b.x[j] + normal_a.y * b.y[j] + normal_a.z * b.z[j] - offset_a);
  double sum = 0;
  for (std::size_t i = 0; i < Points; ++i) {
    const double over_b = normal_b.x * a.x[i] + normal_b.y * a.y[i] + normal_b.z * a.z[i] - offset_b;
    double row = 0;
    for (std::size_t j = 0; j < Points; ++j) {
      const double dx = b.x[j] - a.x[i], dy = b.y[j] - a.y[i], dz = b.z[j] - a.z[i];
      const double r2 = dx * dx + dy * dy + dz * dz;
      row += over_a[j] / (r2 * r2);
    }
    sum += rule.weight[i] * over_b * row;
  }
  return sum / std::numbers::pi;
}

}  // namespace clerestory
