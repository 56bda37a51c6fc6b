#include "solver/particles/surface_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "solver/geometry/triangle.h"
#include "solver/model/parallel.h"
#include "solver/sampling/gauss_legendre.h"

namespace clerestory {
namespace {

/// Patches turned farther than this from those at the point are another surface: cosine.
constexpr double kAlike = 0.5;

double value(KernelShape shape, double r2_over_h2) {
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

/// Integrals of K, K x, K y, K x^2, K x y, K y^2 over a part of the plane, in units of h around the kernel's centre.
struct Moments {
  double one = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
};

/// Adds those of the triangle between the centre and the edge from (ax, ay) to (bx, by), with the sign of its turn:
/// summed over the edges of a polygon its inside is left. Exact but for 8 Gauss nodes over the angle.
void add_edge(KernelShape shape, double ax, double ay, double bx, double by, Moments& m) {
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

/// a and b of w = K (a + b . d), in units of h; b is zero where the surface is too narrow to tell a slope.
std::array<double, 3> weights(const Moments& m) {
  const double det = m.xx * m.yy - m.xy * m.xy, trace = m.xx + m.yy;
  if (det > 1e-6 * trace * trace) {
    // b = -S^-1 (x, y) a, from the integrals of w d = 0.
    const double bx = -(m.yy * m.x - m.xy * m.y) / det, by = -(m.xx * m.y - m.xy * m.x) / det;
    const double all = m.one + bx * m.x + by * m.y;
    if (all > 0.02 * m.one) return {1 / all, bx / all, by / all};
  }
  return {1 / m.one, 0, 0};
}

}  // namespace

double second_moment(KernelShape shape) { return radial(shape, 2, 1) / radial(shape, 0, 1) / 2; }

std::vector<double> edge_lengths(const PatchSet& patches, const VertexLightmap& map) {
  std::vector<double> area(map.position.size(), 0.0), count(map.position.size(), 0.0);
  for (std::size_t i = 0; i < map.corners.size(); ++i)
    for (const std::uint32_t p : map.corners[i]) area[p] += patches.area[i], ++count[p];
  for (std::size_t p = 0; p < area.size(); ++p)
    area[p] = count[p] > 0 ? std::sqrt(4 / std::sqrt(3.0) * area[p] / count[p]) : 0;
  return area;
}

SurfaceKernels::SurfaceKernels(const PatchSet& patches, const VertexLightmap& map, std::span<const double> radius,
                               KernelShape shape)
    : shape_(shape), points_(map.position.size()), begin_(map.position.size() + 1, 0) {
  // Patches by point.
  std::vector<std::uint32_t> first(points_.size() + 1, 0), around;
  for (const auto& corners : map.corners)
    for (const std::uint32_t p : corners) ++first[p + 1];
  for (std::size_t p = 0; p < points_.size(); ++p) first[p + 1] += first[p];
  around.resize(first.back());
  {
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t i = 0; i < map.corners.size(); ++i)
      for (const std::uint32_t p : map.corners[i]) around[next[p]++] = i;
  }
  std::vector<std::vector<Part>> parts(points_.size());
  parallel_for(points_.size(), 64, [&](std::size_t from, std::size_t to) {
    std::vector<std::uint32_t> reached;
    for (std::size_t p = from; p < to; ++p) {
      const Vec3 at = map.position[p];
      const double h = radius[p];
      Point& point = points_[p];
      point = {at, {}, 0, h * h};
      if (first[p] == first[p + 1] || !(h > 0)) continue;
      Vec3 normal;
      for (std::uint32_t k = first[p]; k < first[p + 1]; ++k)
        normal += patches.normal[around[k]] * patches.area[around[k]];
      const Frame frame(normalized(normal));
      reached.assign(around.begin() + first[p], around.begin() + first[p + 1]);
      const std::size_t own = reached.size();
      Moments m;
      for (std::size_t k = 0; k < reached.size(); ++k) {
        const std::uint32_t i = reached[k];
        const Vec3& n = patches.normal[i];
        const auto corners = patches.corner_positions(PatchId{std::size_t{i}});
        const double height = dot(n, at - corners[0]);
        if (k >= own) {
          const Vec3 off = nearest_point(corners, at) - at;
          if (dot(n, frame.n) < kAlike || dot(off, off) >= h * h) continue;
        }
        parts[p].push_back({i, static_cast<float>(height * height)});
        const Vec3 foot = at - n * height;
        // Along the facet; its directions stand for those of the tangent plane.
        std::array<double, 3> x, y;
        for (std::size_t c = 0; c < 3; ++c) {
          const Vec3 d = corners[c] - foot;
          const double u = dot(d, frame.t), v = dot(d, frame.b), flat = u * u + v * v, r = length(d);
          const double stretch = flat > 0 ? r / std::sqrt(flat) / h : 0;
          x[c] = u * stretch, y[c] = v * stretch;
        }
        for (std::size_t c = 0; c < 3; ++c) add_edge(shape_, x[c], y[c], x[(c + 1) % 3], y[(c + 1) % 3], m);
        for (const std::uint32_t corner : map.corners[i])
          for (std::uint32_t next = first[corner]; next < first[corner + 1]; ++next)
            if (std::ranges::find(reached, around[next]) == reached.end()) reached.push_back(around[next]);
      }
      if (!(m.one > 0)) {
        parts[p].clear();
        continue;
      }
      const auto [a, bx, by] = weights(m);
      point.a = a / (h * h);
      point.along = (frame.t * bx + frame.b * by) / (h * h * h);
    }
  });
  for (std::size_t p = 0; p < points_.size(); ++p) begin_[p + 1] = begin_[p] + parts[p].size();
  parts_.reserve(begin_.back());
  for (const auto& of_point : parts) parts_.insert(parts_.end(), of_point.begin(), of_point.end());
}

template <KernelShape shape>
Spectrum SurfaceKernels::sum(std::size_t p, const LandingsByPatch& landings) const {
  const Point& at = points_[p];
  const double x = at.position.x, y = at.position.y, z = at.position.z, per_radius2 = 1 / at.radius2;
  Spectrum E(0.0);
  for (std::size_t k = begin_[p]; k < begin_[p + 1]; ++k) {
    const double within = at.radius2 + double{parts_[k].height2};
    for (const Landing& landing : landings[parts_[k].patch]) {
      const double dx = double{landing.position[0]} - x, dy = double{landing.position[1]} - y,
                   dz = double{landing.position[2]} - z, r2 = dx * dx + dy * dy + dz * dz;
      if (r2 >= within) continue;
      const double q = std::max(0.0, (r2 - double{parts_[k].height2}) * per_radius2);
      const double w = value(shape, q) * (at.a + at.along.x * dx + at.along.y * dy + at.along.z * dz);
      E += Spectrum(double{landing.flux[0]}, double{landing.flux[1]}, double{landing.flux[2]}) * w;
    }
  }
  return E;
}

Spectrum SurfaceKernels::irradiance(std::size_t p, const LandingsByPatch& landings) const {
  switch (shape_) {
    case KernelShape::constant:
      return sum<KernelShape::constant>(p, landings);
    case KernelShape::cone:
      return sum<KernelShape::cone>(p, landings);
    case KernelShape::epanechnikov:
      break;
  }
  return sum<KernelShape::epanechnikov>(p, landings);
}

}  // namespace clerestory
