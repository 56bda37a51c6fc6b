#include "solver/form_factors/contour_exchange.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "solver/sampling/gauss_legendre.h"

namespace clerestory {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// On a panel no wider than its distance from the nearest singularity twelve Gauss points leave about 1e-15: the
/// integrand is analytic in an ellipse of half-axis sum 2 + sqrt(5), and the error falls like that to the power -24.
constexpr std::size_t kPanelPoints = 12;

/// First integral of ln sqrt(u2 + H2) over u, zero at u = 0.
double log_integral(double u, double H) {
  const double r2 = u * u + H * H;
  if (r2 == 0) return 0;
  return u * (0.5 * std::log(r2) - 1) + (H > 0 ? H * std::atan(u / H) : 0);
}

/// Second integral of the same, for parallel edges at distance H.
double log_integral_twice(double u, double H) {
  const double r2 = u * u + H * H;
  if (r2 == 0) return 0;
  return 0.25 * (u * u - H * H) * std::log(r2) - 0.75 * u * u + (H > 0 ? u * H * std::atan(u / H) : 0);
}

/// An edge pair seen from the nearest points of its two lines, with t turned so that cos >= 0.
struct SkewLines {
  double s0, s1, t0, t1;  ///< ends of the edges along their lines
  double cos, sin, d;     ///< angle between the lines, 0 < angle <= pi / 2, and their distance
};

/// int over t of ln r at fixed s. By symmetry also int over s at fixed t, with the ranges swapped.
double edge_integral(double s, double t0, double t1, const SkewLines& lines) {
  const double height = std::hypot(s * lines.sin, lines.d);
  return log_integral(t1 - lines.cos * s, height) - log_integral(t0 - lines.cos * s, height);
}

/// The integrand of the remainder, see below, over u0..u1.
double panel(double u0, double u1, const SkewLines& lines) {
  static const GaussLegendre<kPanelPoints> rule;
  const double middle = 0.5 * (u0 + u1), half = 0.5 * (u1 - u0), width = lines.t1 - lines.t0;
  double sum = 0;
  for (std::size_t k = 0; k < kPanelPoints; ++k) {
    const double e = std::exp(middle + half * rule.node[k]), inverse = 1 / e;
    const double s = 0.5 * (e - inverse) * lines.d / lines.sin, h = 0.5 * (e + inverse) * lines.d;
    const double c_s = lines.cos * s;
    // atan((t1 - c s) / h) - atan((t0 - c s) / h) in one call; the angle is in (0, pi).
    sum += rule.weight[k] * std::atan2(width * h, h * h + (lines.t1 - c_s) * (lines.t0 - c_s));
  }
  return sum * half;
}

/// d2 int int ds dt / r2 = d2 / sin * int du [atan((t1 - c s) / h) - atan((t0 - c s) / h)],
/// s = d / sin * sinh u, h = d cosh u. The integrand is singular only at u_k = asinh(sin z_k / d),
/// z_k = c t_k +- i sqrt(t_k2 sin2 + d2), which keep a distance of the order of the lines' angle from the real axis.
double skew_remainder(const SkewLines& lines) {
  std::array<std::complex<double>, 4> singular;
  for (std::size_t k = 0; k < 2; ++k) {
    const double t = k == 0 ? lines.t0 : lines.t1;
    const double scale = lines.sin / lines.d;
    const auto u = std::asinh(std::complex<double>(scale * lines.cos * t, scale * std::hypot(t * lines.sin, lines.d)));
    singular[2 * k] = {u.real(), std::abs(u.imag())};
    singular[2 * k + 1] = {-u.real(), std::numbers::pi - std::abs(u.imag())};  // asinh's other branch
  }
  const auto distance = [&](double u0, double u1) {
    double nearest2 = std::numeric_limits<double>::max();
    for (const auto& z : singular) {
      const double along = std::max({u0 - z.real(), z.real() - u1, 0.0});
      nearest2 = std::min(nearest2, along * along + z.imag() * z.imag());
    }
    return std::sqrt(nearest2);
  };
  const double end = std::asinh(lines.s1 * lines.sin / lines.d);
  double begin = std::asinh(lines.s0 * lines.sin / lines.d);
  double sum = 0;
  // Panels from left to right, as wide as the singularities allow.
  while (begin < end) {
    double width = end - begin;
    while (width > distance(begin, begin + width)) width *= 0.5;
    // What would be left narrower than a panel is shared out evenly.
    const double left = end - begin;
    if (left - width < width && left > width) width = 0.5 * left;
    const double next = left - width < 1e-9 * width ? end : begin + width;
    sum += panel(begin, next, lines);
    begin = next;
  }
  return sum * lines.d * lines.d / lines.sin;
}

struct Edge {
  Vec3 start, direction;  ///< direction is unit
  double length;
};

/// Integral over an edge pair, and the sum of its terms' magnitudes for the rounding bound.
struct EdgePair {
  double value, magnitude;
};

EdgePair edge_pair(const Edge& a, const Edge& b, double cosine) {
  const Vec3 w = b.start - a.start;
  const Vec3 normal = cross(a.direction, b.direction);
  const double sin2 = dot(normal, normal), sin = std::sqrt(sin2);
  const double longest = std::max(a.length, b.length), area = a.length * b.length;

  if (sin * longest <= 1e-13 * std::max(longest, length(w))) {
    // Parallel: r depends on t - s only, and the second integral at the four differences of the ends is all.
    const double along = dot(w, a.direction);
    const double H = length(w - a.direction * along);
    const double first = cosine > 0 ? along : along - b.length;  // b's lower end, measured along a
    const double terms[4] = {log_integral_twice(first + b.length, H), log_integral_twice(first, H),
                             log_integral_twice(first + b.length - a.length, H),
                             log_integral_twice(first - a.length, H)};
    const double size = std::abs(terms[0]) + std::abs(terms[1]) + std::abs(terms[2]) + std::abs(terms[3]);
    return {terms[0] - terms[1] - terms[2] + terms[3], size};
  }

  const double s_near = dot(cross(w, b.direction), normal) / sin2;
  const double t_near = dot(cross(w, a.direction), normal) / sin2;
  SkewLines lines{.s0 = -s_near,
                  .s1 = a.length - s_near,
                  .t0 = -t_near,
                  .t1 = b.length - t_near,
                  .cos = std::abs(cosine),
                  .sin = sin,
                  .d = std::abs(dot(w, normal)) / sin};
  if (cosine < 0) lines = {lines.s0, lines.s1, -lines.t1, -lines.t0, lines.cos, lines.sin, lines.d};

  // Nearly parallel skew lines come nearest far away, and the boundary terms, all as long, would cancel.
  const double reach = std::max({std::abs(lines.s0), std::abs(lines.s1), std::abs(lines.t0), std::abs(lines.t1)});
  if (reach > 1e3 * std::max(longest, length(w))) {
    const double value = segment_log_integral_by_quadrature(a.start, a.start + a.direction * a.length, b.start,
                                                            b.start + b.direction * b.length);
    return {value, std::abs(value) + area};
  }

  const double terms[4] = {lines.s1 * edge_integral(lines.s1, lines.t0, lines.t1, lines),
                           lines.s0 * edge_integral(lines.s0, lines.t0, lines.t1, lines),
                           lines.t1 * edge_integral(lines.t1, lines.s0, lines.s1, lines),
                           lines.t0 * edge_integral(lines.t0, lines.s0, lines.s1, lines)};
  double remainder = 0;
  // The remainder is at most pi d times the shorter edge, so a distance that is only rounding leaves it out.
  if (lines.d > 1e-15 * (longest + length(w))) remainder = skew_remainder(lines);
  const double size = std::abs(terms[0]) + std::abs(terms[1]) + std::abs(terms[2]) + std::abs(terms[3]);
  return {0.5 * (terms[0] - terms[1] + terms[2] - terms[3] - area + remainder), size + area};
}

Edge edge_between(const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double l = length(along);
  return {from, l > 0 ? along / l : Vec3{}, l};
}

}  // namespace

ContourSum contour_exchange(std::span<const Vec3> polygon1, std::span<const Vec3> polygon2) {
  ContourSum sum;
  if (polygon1.size() < 3 || polygon2.size() < 3) return sum;
  // The contours are closed, so ln r may be replaced by ln(r / unit). With a unit near the mean distance its values,
  // and with them the cancelling terms, are small.
  double span = 0;
  for (const Vec3& x : polygon1) span = std::max(span, length(x - polygon2[0]));
  for (const Vec3& x : polygon2) span = std::max(span, length(x - polygon1[0]));
  if (!(span > 0) || !std::isfinite(span)) return sum;
  const Vec3 origin = polygon1[0];
  const double unit = 0.5 * span;
  const auto scaled = [&](const Vec3& x) { return (x - origin) / unit; };

  for (std::size_t j = 0; j < polygon2.size(); ++j) {
    const Edge b = edge_between(scaled(polygon2[j]), scaled(polygon2[(j + 1) % polygon2.size()]));
    if (b.length == 0) continue;
    for (std::size_t i = 0; i < polygon1.size(); ++i) {
      const Edge a = edge_between(scaled(polygon1[i]), scaled(polygon1[(i + 1) % polygon1.size()]));
      const double cosine = dot(a.direction, b.direction);
      if (a.length == 0 || std::abs(cosine) < 1e-16) continue;  // perpendicular edges exchange nothing
      const EdgePair pair = edge_pair(a, b, cosine);
      sum.value += cosine * pair.value;
      sum.rounding += std::abs(cosine) * pair.magnitude;
    }
  }
  const double to_area = unit * unit / (2 * std::numbers::pi);
  return {sum.value * to_area, sum.rounding * kEpsilon * to_area};
}

double segment_log_integral_by_quadrature(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  const Edge a = edge_between(a0, a1), b = edge_between(b0, b1);
  if (a.length == 0 || b.length == 0) return 0;
  const auto inner = [&](double s) {
    const Vec3 to_b = b.start - a.start - a.direction * s;
    const double along = dot(to_b, b.direction);
    const double H = length(to_b - b.direction * along);
    return log_integral(along + b.length, H) - log_integral(along, H);
  };
  // Singular nearest to the feet of b's ends on a, and where the two lines come nearest.
  std::array<double, 5> breaks{0, dot(b0 - a0, a.direction), dot(b1 - a0, a.direction), 0, a.length};
  const Vec3 normal = cross(a.direction, b.direction);
  const double sin2 = dot(normal, normal);
  if (sin2 > 0) breaks[3] = dot(cross(b0 - a0, b.direction), normal) / sin2;
  for (double& x : breaks) x = std::clamp(x, 0.0, a.length);
  std::ranges::sort(breaks);

  constexpr double kStep = 1.0 / 16;
  constexpr int kTerms = 56;  // the last abscissa is 1e-24 of the panel away from its end
  double sum = 0;
  for (std::size_t p = 0; p + 1 < breaks.size(); ++p) {
    const double half = 0.5 * (breaks[p + 1] - breaks[p]);
    if (half == 0) continue;
    double panel_sum = 0;
    for (int k = -kTerms; k <= kTerms; ++k) {
      const double x = kStep * k, y = std::numbers::pi / 2 * std::sinh(x);
      const double cosh_y = std::cosh(y);
      const double weight = std::numbers::pi / 2 * std::cosh(x) / (cosh_y * cosh_y);
      const double from_end = 1 / (std::exp(std::abs(y)) * cosh_y);  // 1 - |tanh y|, without cancellation
      const double s = k < 0 ? breaks[p] + half * from_end : breaks[p + 1] - half * from_end;
      panel_sum += weight * inner(s);
    }
    sum += panel_sum * half * kStep;
  }
  return sum;
}

}  // namespace clerestory
