#include "solver/sampling/plane_kernel.h"

#include <algorithm>
#include <cmath>

#include "solver/sampling/gauss_legendre.h"

namespace clerestory {

double kernel(KernelShape shape, double r2_over_h2) {
  switch (shape) {
    case KernelShape::constant:
      return 1;
    case KernelShape::cone:
      return 1 - std::sqrt(r2_over_h2);
    case KernelShape::epanechnikov:
      break;
  }
  return 1 - r2_over_h2;
}

namespace {

/// Integral of K(r) r^(1 + k) from 0 to R, in units of h.
double radial(KernelShape shape, int k, double R) {
  const double n = k + 2, power = k == 0 ? R * R : k == 1 ? R * R * R : R * R * R * R;
  switch (shape) {
    case KernelShape::constant:
      return power / n;
    case KernelShape::cone:
      return power / n - power * R / (n + 1);
    case KernelShape::epanechnikov:
      break;
  }
  return power / n - power * R * R / (n + 2);
}

}  // namespace

void add_edge(KernelShape shape, double ax, double ay, double bx, double by, KernelMoments& m) {
  static const GaussLegendre<8> gauss;
  const double turn = ax * by - ay * bx, edge = std::hypot(bx - ax, by - ay);
  if (!(std::abs(turn) > 1e-14 * edge)) return;
  // Angles from the foot of the perpendicular, in the sense of the turn.
  const double sign = turn > 0 ? 1 : -1, d = std::abs(turn) / edge;
  const double tx = sign * (bx - ax) / edge, ty = sign * (by - ay) / edge;  // along the edge, counter-clockwise
  const double fx = ty, fy = -tx;                                           // to the foot
  double from = std::atan2(ax * tx + ay * ty, d), to = std::atan2(bx * tx + by * ty, d);
  if (from > to) std::swap(from, to);
  const double inside = d < 1 ? std::acos(d) : 0;  // the edge lies within the kernel up to that angle
  const std::array<double, 4> ends{from, std::clamp(-inside, from, to), std::clamp(inside, from, to), to};
  for (std::size_t part = 0; part < 3; ++part) {
    const double low = ends[part], high = ends[part + 1];
    if (!(high > low)) continue;
    for (std::size_t k = 0; k < gauss.node.size(); ++k) {
      const double angle = (low + high) / 2 + (high - low) / 2 * gauss.node[k], c = std::cos(angle),
                   s = std::sin(angle);
      const double R = part == 1 ? std::min(1.0, d / c) : 1.0, w = sign * gauss.weight[k] * (high - low) / 2;
      const double x = fx * c + tx * s, y = fy * c + ty * s;
      const double first = w * radial(shape, 1, R), second = w * radial(shape, 2, R);
      m.one += w * radial(shape, 0, R);
      m.x += first * x, m.y += first * y;
      m.xx += second * x * x, m.xy += second * x * y, m.yy += second * y * y;
    }
  }
}

std::array<double, 3> kernel_weights(const KernelMoments& m) {
  const double det = m.xx * m.yy - m.xy * m.xy, trace = m.xx + m.yy;
  if (det > 1e-6 * trace * trace) {
    // b = -S^-1 (x, y) a, from the integrals of w d = 0.
    const double bx = -(m.yy * m.x - m.xy * m.y) / det, by = -(m.xx * m.y - m.xy * m.x) / det;
    const double all = m.one + bx * m.x + by * m.y;
    if (all > 0.02 * m.one) return {1 / all, bx / all, by / all};
  }
  return {1 / m.one, 0, 0};
}

double second_moment(KernelShape shape) { return radial(shape, 2, 1) / radial(shape, 0, 1) / 2; }

}  // namespace clerestory
