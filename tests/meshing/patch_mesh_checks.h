#pragma once
// What must hold for patches joined at their edges.

#include <array>
#include <sstream>
#include <string>
#include <vector>

#include <OpenMesh/Tools/Utils/MeshCheckerT.hh>

#include "meshing/patch_mesh.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory::testing {

/// The half-edges of patch p, by its corners.
inline std::array<OpenMesh::SmartHalfedgeHandle, 3> half_edges(const PatchMesh& mesh, std::size_t p) {
  const auto first = OpenMesh::make_smart(mesh.face_handle(static_cast<unsigned>(p)), mesh).halfedge();
  return {first, first.next(), first.next().next()};
}

/// What OpenMesh's own checker finds, in its words; empty when it agrees.
inline std::string wrong_links(const PatchMesh& mesh) {
  using Checker = OpenMesh::Utils::MeshCheckerT<PatchMesh>;
  std::ostringstream found;
  const bool good = Checker(mesh).check(Checker::CHECK_ALL, found);
  return good ? "" : found.str() + "not good";
}

/// Edges of patches over which another patch lies than the lightmap says.
inline std::size_t lost_neighbours(const PatchMesh& mesh, const VertexLightmap& map) {
  std::size_t count = 0;
  for (std::size_t p = 0; p < map.neighbour.size(); ++p) {
    const auto edges = half_edges(mesh, p);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto other = edges[k].opp().face();
      const std::uint32_t q = other.is_valid() ? static_cast<std::uint32_t>(other.idx()) : VertexLightmap::kNone;
      count += q != map.neighbour[p][k] || edges[k].face().idx() != static_cast<int>(p);
    }
  }
  return count;
}

/// Corners that do not lie where the others of their fan do.
inline std::size_t torn_corners(const PatchSet& patches, const PatchMesh& mesh) {
  std::vector<Vec3> place = patches.vertices;
  std::vector<bool> placed(place.size(), true);
  place.resize(mesh.n_vertices()), placed.resize(mesh.n_vertices(), false);
  std::size_t count = 0;
  for (std::size_t p = 0; p < patches.patch_count(); ++p) {
    const auto x = patches.corner_positions(PatchId{p});
    const auto edges = half_edges(mesh, p);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto fan = static_cast<std::size_t>(edges[k].from().idx());
      if (!placed[fan]) place[fan] = x[k], placed[fan] = true;
      count += !(place[fan] == x[k]);
    }
  }
  return count;
}

}  // namespace clerestory::testing
