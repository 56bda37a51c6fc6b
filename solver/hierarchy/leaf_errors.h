#pragma once
// How well the leaves of a mesh interpolate what is known at their vertices.

#include <cstdint>
#include <vector>

#include "solver/hierarchy/element_mesh.h"
#include "solver/hierarchy/vertex_field.h"

namespace clerestory {

/// How a leaf interpolates between its vertices, luminous means [W/m2].
struct LeafError {
  std::uint32_t leaf;  ///< element of the mesh
  double off;          ///< how far the middle of an edge may lie off the straight line
  double soft;         ///< the same without sun and luminaires, whose edges no halving resolves
  double E;            ///< irradiance there; at least the darkest that counts
  double std_error;    ///< standard error at the vertices
  /// What it adds to RMS errors of its room [1]: `off` to that of relative errors, `soft` to that relative to the mean.
  double relative, of_mean;
};

/// Errors of leaves while elements are halved: from one look to the next only those around new points change.
class LeafErrors {
 public:
  /// mesh, field  outlive this. Points of the mesh only become more, and what the field knows of one stays.
  LeafErrors(const ElementMesh& mesh, const VertexField& field) : mesh_(mesh), field_(field) {}

  /// Of each leaf whose vertices were gathered, and that is new since the last call or shares a point with one that is;
  /// at the first call of all.
  std::vector<LeafError> of_changed();

 private:
  std::vector<std::uint32_t> changed_leaves();
  void find_rooms(const std::vector<std::uint32_t>& leaves);

  const ElementMesh& mesh_;
  const VertexField& field_;
  std::vector<ElementMesh::Corners> points_;    ///< by element: of leaves, as of the last call
  std::vector<double> E_, soft_E_;              ///< by point, luminous means
  std::vector<bool> is_changed_;                ///< by point, since the last call
  std::vector<Vec3> gradient_, soft_gradient_;  ///< by point
  std::vector<double> mean_, area_;             ///< by room, of what was gathered at the first call
};

}  // namespace clerestory
