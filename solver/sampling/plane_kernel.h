#pragma once
// Kernels of a density estimate on a part of the plane.

#include <array>

namespace clerestory {

/// How particles count by their distance r, up to the radius h of a kernel: all alike, 1 - r / h, 1 - (r / h)^2.
enum class KernelShape { constant, cone, epanechnikov };

/// Mean of x^2 over the kernel, x a coordinate along the surface, over h^2 [1]: 1/4, 3/20, 1/6. The estimate is off by
/// half of that times h^2 times the Laplacian of the irradiance.
double second_moment(KernelShape shape);

/// K by (r / h)^2, up to 1; not normalised.
double kernel(KernelShape shape, double r2_over_h2);

/// Integrals of K, K x, K y, K x^2, K x y, K y^2 over a part of the plane, in units of h around the kernel's centre.
struct KernelMoments {
  double one = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
};

/// Adds those of the triangle between the centre and the edge from (ax, ay) to (bx, by), with the sign of its turn:
/// summed over the edges of a polygon its inside is left. Exact but for 8 Gauss nodes over the angle.
void add_edge(KernelShape shape, double ax, double ay, double bx, double by, KernelMoments& m);

/// a and b of w = K (a + b . d), in units of h, so that the integrals of w and of w d over the part are 1 and 0; b is
/// zero where the part is too narrow to tell a slope. Needs: m.one > 0.
std::array<double, 3> kernel_weights(const KernelMoments& m);

}  // namespace clerestory
