#pragma once
// Irradiance at the vertices of a mesh from particles that land around them.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/vertex_lightmap.h"
#include "solver/particles/landings.h"
#include "solver/sampling/plane_kernel.h"

namespace clerestory {

/// A kernel around a place of a smooth surface:
///   E = sum of flux w(x - place),    w(d) = K(|d|) (a + b . d)
/// with a and b such that an irradiance that is constant, or linear along the surface, comes out as it is whatever part
/// of the kernel lies on the surface: the integrals of w and of w d over it are 1 and 0. They are taken exactly, over
/// edges of the patches. Distances are along the plane of the patch that is hit.
/// Source: Silverman, "Density estimation", 1986; Walter, Hubbard, Shirley & Greenberg, "Global illumination using
/// local linear density estimation", 1997.
struct SurfaceKernel {
  /// A patch that it reaches.
  struct Part {
    std::uint32_t patch;
    float height2;  ///< of the place over its plane, squared [m2]
  };
  Vec3 place, along;          ///< along: b
  double a = 0, radius2 = 0;  ///< a: what a particle counts that lands right at the place [1/m2]; 0 without a surface
  KernelShape shape = KernelShape::epanechnikov;

  /// Of a particle that lands at x, on a patch of that Part::height2 [1/m2].
  double weight(const std::array<float, 3>& x, double height2) const {
    const Vec3 d = Vec3{double{x[0]}, double{x[1]}, double{x[2]}} - place;
    const double r2 = dot(d, d);
    if (r2 >= radius2 + height2) return 0;
    return kernel(shape, std::max(0.0, r2 - height2) / radius2) * (a + dot(along, d));
  }
};

/// Patches of a mesh, and how they go on from each other as one smooth surface.
class SmoothSurface {
 public:
  /// Patches turned farther than this from those at a place are another surface: cosine.
  static constexpr double kAlike = 0.5;

  /// Both outlive this.
  SmoothSurface(const PatchSet& patches, const VertexLightmap& map);

  const PatchSet& patches() const { return patches_; }
  /// That share the point.
  std::span<const std::uint32_t> patches_at(std::size_t point) const {
    return std::span(patch_).subspan(begin_[point], begin_[point + 1] - begin_[point]);
  }
  /// Around a place of the patches `own`, of radius h [m].
  ///
  /// parts  room that is used again; filled with what it reaches.
  SurfaceKernel kernel(const Vec3& place, std::span<const std::uint32_t> own, double h, KernelShape shape,
                       std::vector<SurfaceKernel::Part>& parts) const;

 private:
  const PatchSet& patches_;
  const VertexLightmap& map_;
  std::vector<std::uint32_t> begin_, patch_;  ///< by point
};

/// A kernel around each point of a lightmap.
///
/// radius  P [m]. Memory: 8 bytes for each patch that a kernel reaches, about 25 of them a point at kEdges.
class SurfaceKernels {
 public:
  SurfaceKernels() = default;
  SurfaceKernels(const PatchSet& patches, const VertexLightmap& map, std::span<const double> radius,
                 KernelShape shape = KernelShape::epanechnikov);

  std::size_t size() const { return begin_.size() - 1; }
  /// Whether any surface lies around the point.
  bool has_surface(std::size_t point) const { return begin_[point + 1] > begin_[point]; }
  /// What a particle counts that lands right at the point [1/m2]; 0 without a surface.
  double largest_weight(std::size_t point) const { return kernels_[point].a; }
  /// Irradiance at a point [W/m2] by landings, whose flux is that of as many particles as were followed.
  Spectrum irradiance(std::size_t point, const LandingsByPatch& landings) const;

 private:
  std::vector<SurfaceKernel> kernels_;
  std::vector<std::size_t> begin_{0};
  std::vector<SurfaceKernel::Part> parts_;
};

/// Length of a mesh's edges at each point [m]: of equilateral triangles that have the mean area of the patches there.
std::vector<double> edge_lengths(const PatchSet& patches, const VertexLightmap& map);

}  // namespace clerestory
