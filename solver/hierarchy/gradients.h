#pragma once
// How what is known at the vertices of a mesh changes from one to the next.

#include <cstdint>
#include <span>
#include <vector>

#include "solver/hierarchy/element_mesh.h"

namespace clerestory {

/// Gradient at points of the mesh of what E is there, averaged over the leaves around each by area; leaves across the
/// edge of a shadow have none.
///
/// leaves    all around the points that are asked for.
/// of        by point: whether it is asked for. gradient: of the others it is left as it is.
/// E         by point.
void find_gradients(const ElementMesh& mesh, std::span<const std::uint32_t> leaves, const std::vector<double>& E,
                    const std::vector<bool>& of, std::vector<Vec3>& gradient);

/// How far the middle of edge k of a leaf lies off the straight line between its ends, as the gradient turns from one
/// to the other: exact for quadratic E.
inline double bulge(const std::array<Vec3, 3>& x, const ElementMesh::Corners& point, const std::vector<Vec3>& gradient,
                    std::size_t k) {
  const std::size_t next = (k + 1) % 3;
  return dot(gradient[point[k]] - gradient[point[next]], x[next] - x[k]) / 8;
}

/// Mean irradiance of each leaf from the field at its corners, with what the turning of the gradient says about how far
/// the middle lies off them: exact for quadratic light, where the mean of the corners loses what light bulges [W/m2].
Field leaf_irradiance(const ElementMesh& mesh, const Field& E);

}  // namespace clerestory
