#include "meshing/patch_mesh.h"

#include <algorithm>
#include <vector>

#include "solver/model/vertex_lightmap.h"

namespace clerestory {
namespace {

using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

/// Corner k of patch p, in the patch's order.
VertexHandle corner(const PatchSet& patches, std::size_t p, std::size_t k) {
  const auto& c = patches.corners[patches.triangle[p]];
  return VertexHandle(static_cast<int>(c[patches.side[p] == kFront ? k : (3 - k) % 3].value));
}

/// Faces whose edges run between the vertices of the triangles. Not by add_face, which knows one edge between two
/// vertices: at the foot of a wall one element long there is one on either side.
void add_faces(const PatchSet& patches, std::span<const std::array<std::uint32_t, 3>> neighbour, PatchMesh& mesh) {
  const std::size_t count = patches.patch_count();
  std::size_t open = 0;
  for (const auto& n : neighbour)
    open += static_cast<std::size_t>(std::count(n.begin(), n.end(), VertexLightmap::kNone));
  mesh.reserve(patches.vertices.size(), (3 * count + open) / 2, count);
  for (std::size_t v = 0; v < patches.vertices.size(); ++v) mesh.new_vertex();
  std::vector<std::array<HalfedgeHandle, 3>> edges(count);
  for (std::size_t p = 0; p < count; ++p)
    for (std::size_t k = 0; k < 3; ++k) {
      if (edges[p][k].is_valid()) continue;  // came with its neighbour's
      const VertexHandle from = corner(patches, p, k), to = corner(patches, p, (k + 1) % 3);
      edges[p][k] = mesh.new_edge(from, to);
      const std::uint32_t q = neighbour[p][k];
      if (q == VertexLightmap::kNone) continue;
      for (std::size_t j = 0; j < 3; ++j)
        if (neighbour[q][j] == p && corner(patches, q, j) == to && corner(patches, q, (j + 1) % 3) == from)
          edges[q][j] = mesh.opposite_halfedge_handle(edges[p][k]);
    }
  for (const auto& own : edges) {
    const auto face = mesh.new_face();
    mesh.set_halfedge_handle(face, own[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.set_face_handle(own[k], face);
      mesh.set_next_halfedge_handle(own[k], own[(k + 1) % 3]);
    }
  }
}

/// A boundary goes on at the other end of the fan of faces around the vertex that it comes to.
void link_boundaries(PatchMesh& mesh) {
  for (const auto edge : mesh.edges()) {
    const auto boundary = edge.h1();  // h0 is the face's that made the edge
    if (!boundary.is_boundary()) continue;
    auto out = boundary.opp();
    while (!out.is_boundary()) out = out.prev().opp();
    mesh.set_next_halfedge_handle(boundary, out);
  }
}

/// Fans that meet in a vertex part.
void part_fans(PatchMesh& mesh) {
  std::vector<bool> seen(mesh.n_halfedges(), false);
  for (int i = 0; i < static_cast<int>(seen.size()); ++i) {
    if (seen[static_cast<std::size_t>(i)]) continue;
    const HalfedgeHandle first(i);
    VertexHandle fan = mesh.from_vertex_handle(first);
    if (!mesh.is_isolated(fan)) fan = mesh.new_vertex();
    mesh.set_halfedge_handle(fan, first);
    HalfedgeHandle out = first;
    do {
      seen[static_cast<std::size_t>(out.idx())] = true;
      mesh.set_vertex_handle(mesh.opposite_halfedge_handle(out), fan);
      if (mesh.is_boundary(out)) mesh.set_halfedge_handle(fan, out);  // OpenMesh starts there
      out = mesh.cw_rotated_halfedge_handle(out);
    } while (out != first);
  }
}

}  // namespace

PatchMesh join_patches(const PatchSet& patches, std::span<const std::array<std::uint32_t, 3>> neighbour) {
  PatchMesh mesh;
  add_faces(patches, neighbour, mesh);
  link_boundaries(mesh);
  part_fans(mesh);
  return mesh;
}

}  // namespace clerestory
