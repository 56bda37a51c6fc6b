#pragma once
// What leaves places on the elements of a transport, finer than the mean of each.

#include <array>
#include <vector>

#include "solver/hierarchy/element_mesh.h"

namespace clerestory {

struct VertexField;

/// In a corner half of what a point sees lies so near that the mean of an element is not the light there. First linear
/// across each element, by the means of those around; then between the vertices of a field, on elements halved since.
/// Means of elements stay. What sun and luminaires bring stays even, as their edges are sharper than corners know, and
/// so does what diffusers let through.
class FineRadiosity {
 public:
  /// mesh         its leaves are the elements, in that order; it may be halved from then on. Outlives this, as
  ///              `elements` do.
  /// E            irradiance of the elements, delta_light the part of it from sun and luminaires [W/m2].
  FineRadiosity(const ElementMesh& mesh, const PatchSet& elements, const Field& E, const Field& delta_light);

  /// From here on what the field knows at the points of the mesh as it is now: at all of them.
  void take(const VertexField& field);

  /// What radiosity at x on that element is above its mean; x may be as far beside it as rays in float are [W/m2].
  Spectrum above_mean(PatchId element, const Vec3& x) const;

 private:
  /// x lies at shares to_1 . (x - corner) and to_2 . (x - corner) of corners 1 and 2 of an element.
  struct Place {
    Vec3 corner;
    std::array<float, 3> to_1, to_2;
    std::uint32_t root;  ///< its node
  };
  struct Node {
    std::uint32_t first;  ///< of the parts, the other follows it; of a leaf: its number
    float at;             ///< share of the edge where it is parted; of a leaf 0
    std::uint32_t edge;
  };

  void reset();
  template <class AboveAt>
  void add_leaf(std::size_t element, std::uint32_t leaf, const AboveAt& above_at);

  const ElementMesh& mesh_;
  const PatchSet& elements_;
  Field soft_;                ///< by element: E without sun and luminaires
  Field E_;                   ///< by point, without sun and luminaires
  std::vector<Place> place_;  ///< by element
  std::vector<Node> nodes_;   ///< by element of the mesh
  std::vector<float> above_;  ///< leaves x 3 corners x channels
};

}  // namespace clerestory
