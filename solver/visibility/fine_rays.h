#pragma once
// Rays in double precision, for places where float cannot tell surfaces apart.

#include <memory>
#include <optional>
#include <vector>

#include "solver/model/patch_set.h"

namespace clerestory {

/// The triangles of a PatchSet in double precision. Rays find what they meet to about 1e-15 of the scene, several times
/// slower than RayScene does; nothing leaks between triangles that share an edge. Thread safe.
class FineRays {
 public:
  /// What a ray meets.
  struct Met {
    TriangleId triangle;
    double distance = 0;  ///< in units of the direction's length
    double u = 0, v = 0;  ///< barycentric weights of corners 1 and 2
    bool front = false;   ///< on the side from which the corners run counter-clockwise
  };

  /// patches tells which triangles are glass; vertices and corners, its own or copies, outlive the rays.
  FineRays(const PatchSet& patches, const std::vector<Vec3>& vertices,
           const std::vector<std::array<VertexId, 3>>& corners, double diameter);
  FineRays(FineRays&&) noexcept;
  FineRays& operator=(FineRays&&) noexcept;
  ~FineRays();

  /// First opaque surface (mirrors count) at more than 0 and less than `far`.
  std::optional<Met> first(const Vec3& origin, const Vec3& direction, double far) const;
  /// Panes of glass on the way, from near to far; a pane that is met in the edge of two of its triangles counts once.
  std::vector<Met> glass(const Vec3& origin, const Vec3& direction, double far) const;

  /// Unit normal of its front.
  Vec3 normal(TriangleId t) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace clerestory
