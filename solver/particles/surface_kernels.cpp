#include "solver/particles/surface_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "solver/geometry/triangle.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

/// Numbers that were met, forgotten in no time.
class Met {
 public:
  void forget(std::size_t count) {
    if (stamp_.size() < count) stamp_.resize(count, 0);
    if (++now_ == 0) std::ranges::fill(stamp_, 0), now_ = 1;
  }
  /// Whether it is new.
  bool meet(std::uint32_t number) { return std::exchange(stamp_[number], now_) != now_; }

 private:
  std::vector<std::uint32_t> stamp_;
  std::uint32_t now_ = 0;
};

}  // namespace

std::vector<double> edge_lengths(const PatchSet& patches, const VertexLightmap& map) {
  std::vector<double> area(map.position.size(), 0.0), count(map.position.size(), 0.0);
  for (std::size_t i = 0; i < map.corners.size(); ++i)
    for (const std::uint32_t p : map.corners[i]) area[p] += patches.area[i], ++count[p];
  for (std::size_t p = 0; p < area.size(); ++p)
    area[p] = count[p] > 0 ? std::sqrt(4 / std::sqrt(3.0) * area[p] / count[p]) : 0;
  return area;
}

SmoothSurface::SmoothSurface(const PatchSet& patches, const VertexLightmap& map) : patches_(patches), map_(map) {
  begin_.assign(map.position.size() + 1, 0);
  for (const auto& corners : map.corners)
    for (const std::uint32_t p : corners) ++begin_[p + 1];
  for (std::size_t p = 0; p < map.position.size(); ++p) begin_[p + 1] += begin_[p];
  patch_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t i = 0; i < map.corners.size(); ++i)
    for (const std::uint32_t p : map.corners[i]) patch_[next[p]++] = i;
}

SurfaceKernel SmoothSurface::kernel(const Vec3& at, std::span<const std::uint32_t> own, double h, KernelShape shape,
                                    std::vector<SurfaceKernel::Part>& parts) const {
  SurfaceKernel kernel{at, {}, 0, h * h, shape};
  parts.clear();
  if (own.empty() || !(h > 0)) return kernel;
  Vec3 normal;
  for (const std::uint32_t i : own) normal += patches_.normal[i] * patches_.area[i];
  const Frame frame(normalized(normal));
  thread_local std::vector<std::uint32_t> reached;
  thread_local Met met;
  reached.assign(own.begin(), own.end());
  met.forget(patches_.patch_count());
  for (const std::uint32_t i : own) met.meet(i);
  KernelMoments m;
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const std::uint32_t i = reached[k];
    const Vec3& n = patches_.normal[i];
    const auto corners = patches_.corner_positions(PatchId{std::size_t{i}});
    const double height = dot(n, at - corners[0]);
    if (k >= own.size()) {
      const Vec3 off = nearest_point(corners, at) - at;
      if (dot(n, frame.n) < kAlike || dot(off, off) >= h * h) continue;
    }
    parts.push_back({i, static_cast<float>(height * height)});
    const Vec3 foot = at - n * height;
    // Along the facet; its directions stand for those of the tangent plane.
    std::array<double, 3> x, y;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 d = corners[c] - foot;
      const double u = dot(d, frame.t), v = dot(d, frame.b), flat = u * u + v * v, r = length(d);
      const double stretch = flat > 0 ? r / std::sqrt(flat) / h : 0;
      x[c] = u * stretch, y[c] = v * stretch;
    }
    for (std::size_t c = 0; c < 3; ++c) add_edge(shape, x[c], y[c], x[(c + 1) % 3], y[(c + 1) % 3], m);
    for (const std::uint32_t corner : map_.corners[i])
      for (const std::uint32_t next : patches_at(corner))
        if (met.meet(next)) reached.push_back(next);
  }
  if (!(m.one > 0)) {
    parts.clear();
    return kernel;
  }
  const auto [a, bx, by] = kernel_weights(m);
  kernel.a = a / (h * h);
  kernel.along = (frame.t * bx + frame.b * by) / (h * h * h);
  return kernel;
}

SurfaceKernels::SurfaceKernels(const PatchSet& patches, const VertexLightmap& map, std::span<const double> radius,
                               KernelShape shape)
    : kernels_(map.position.size()), begin_(map.position.size() + 1, 0) {
  const SmoothSurface surface(patches, map);
  std::vector<std::vector<SurfaceKernel::Part>> parts(kernels_.size());
  parallel_for(kernels_.size(), 64, [&](std::size_t from, std::size_t to) {
    for (std::size_t p = from; p < to; ++p)
      kernels_[p] = surface.kernel(map.position[p], surface.patches_at(p), radius[p], shape, parts[p]);
  });
  for (std::size_t p = 0; p < kernels_.size(); ++p) begin_[p + 1] = begin_[p] + parts[p].size();
  parts_.reserve(begin_.back());
  for (const auto& of_point : parts) parts_.insert(parts_.end(), of_point.begin(), of_point.end());
}

Spectrum SurfaceKernels::irradiance(std::size_t p, const LandingsByPatch& landings) const {
  const SurfaceKernel& kernel = kernels_[p];
  Spectrum E(0.0);
  for (std::size_t k = begin_[p]; k < begin_[p + 1]; ++k)
    for (const Landing& landing : landings[parts_[k].patch]) {
      const double w = kernel.weight(landing.position, double{parts_[k].height2});
      if (w != 0) E += Spectrum(double{landing.flux[0]}, double{landing.flux[1]}, double{landing.flux[2]}) * w;
    }
  return E;
}

}  // namespace clerestory
