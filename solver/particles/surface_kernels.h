#pragma once
// Irradiance at the vertices of a mesh from particles that land around them.

#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/vertex_lightmap.h"
#include "solver/particles/landings.h"

namespace clerestory {

/// How particles count by their distance r, up to the radius h of a kernel: all alike, 1 - r / h, 1 - (r / h)^2.
enum class KernelShape { constant, cone, epanechnikov };

/// Mean of x^2 over the kernel, x a coordinate along the surface, over h^2 [1]: 1/4, 3/20, 1/6. The estimate is off by
/// half of that times h^2 times the Laplacian of the irradiance.
double second_moment(KernelShape shape);

/// A kernel around each point of a lightmap, over the patches that go on from there as one smooth surface:
///   E(p) = sum of flux w(x - p),    w(d) = K(|d|) (a + b . d)
/// with a and b such that an irradiance that is constant, or linear along the surface, comes out as it is whatever part
/// of the kernel lies on the surface: the integrals of w and of w d over it are 1 and 0. They are taken exactly, over
/// edges of the patches. Distances are along the plane of the patch that is hit.
///
/// radius  P [m]. Memory: 8 bytes for each patch that a kernel reaches, about 25 of them a point at kEdges.
/// Source: Silverman, "Density estimation", 1986; Walter, Hubbard, Shirley & Greenberg, "Global illumination using
/// local linear density estimation", 1997.
class SurfaceKernels {
 public:
  SurfaceKernels() = default;
  SurfaceKernels(const PatchSet& patches, const VertexLightmap& map, std::span<const double> radius,
                 KernelShape shape = KernelShape::epanechnikov);

  std::size_t size() const { return begin_.size() - 1; }
  /// Whether any surface lies around the point.
  bool has_surface(std::size_t point) const { return begin_[point + 1] > begin_[point]; }
  /// What a particle counts that lands right at the point [1/m2]; 0 without a surface.
  double largest_weight(std::size_t point) const { return points_[point].a; }
  /// Irradiance at a point [W/m2] by landings, whose flux is that of as many particles as were followed.
  Spectrum irradiance(std::size_t point, const LandingsByPatch& landings) const;

 private:
  struct Point {
    Vec3 position, along;  ///< b
    double a = 0, radius2 = 0;
  };
  struct Part {
    std::uint32_t patch;
    float height2;  ///< of the point over its plane, squared [m2]
  };
  template <KernelShape shape>
  Spectrum sum(std::size_t point, const LandingsByPatch& landings) const;

  KernelShape shape_ = KernelShape::epanechnikov;
  std::vector<Point> points_;
  std::vector<std::size_t> begin_{0};
  std::vector<Part> parts_;
};

/// Length of a mesh's edges at each point [m]: of equilateral triangles that have the mean area of the patches there.
std::vector<double> edge_lengths(const PatchSet& patches, const VertexLightmap& map);

}  // namespace clerestory
