#pragma once
// Patches joined at their edges, as a half-edge complex.

#include <array>
#include <cstdint>
#include <span>

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>

#include "solver/model/patch_set.h"

namespace clerestory {

/// Who meets whom, and no places: those are PatchSet::vertices.
using PatchMesh = OpenMesh::TriConnectivity;

/// Surfaces are not manifold, but their sides are: around corners and rims, each has one neighbour over an edge. Face p
/// is patch p, counter-clockwise from its side; its half-edge starts at its corner 0. Vertices are fans of patches: the
/// first fan around PatchSet::vertices[v] is vertex v (isolated where no patch is), further ones are numbered after all
/// of those. Open ends are boundary loops.
///
/// patches    not halved: `splits` is empty; no triangle has a corner twice.
/// neighbour  N, as VertexLightmap's. What two patches do not both say over the same two vertices is an open end.
/// Cost: O(N), 56 bytes a patch, and 12 more while it is built.
PatchMesh join_patches(const PatchSet& patches, std::span<const std::array<std::uint32_t, 3>> neighbour);

}  // namespace clerestory
