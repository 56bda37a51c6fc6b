#pragma once
// Elements cut along the edges of shadows.

#include <cstddef>

#include "solver/hierarchy/element_mesh.h"
#include "solver/hierarchy/shortest_edge.h"
#include "solver/illumination/problem.h"
#include "solver/model/monitor.h"

namespace clerestory {

struct ShadowEdgeOptions {
  ShortestEdge shortest_edge{};  ///< elements are not halved below this, for crooked edges not below a quarter of it
  std::size_t most_elements = 1'000'000;
};

/// What was done about them.
struct ShadowEdges {
  std::size_t cut = 0;     ///< elements that an edge goes through, and that were cut along it
  std::size_t halved = 0;  ///< elements whose edge is crooked, or that are too long for it, before that
};

/// Where the sun or a small luminaire draws the edge of a shadow through an element, the element is cut along both ends
/// of the penumbra, each found on the element's edges by bisection: between them light falls evenly from all to
/// nothing, beyond them nothing changes. Elements through which an edge does not run straight, from one of their edges
/// to another, or through which several run, are halved until one does or they are small. Lights that give less than
/// 0.35 of an element's irradiance draw no edge there; those of one of several times, less than that of what it has in
/// the mean of them.
///
/// Penumbrae narrower than 2 % of an element, but no more than 5 mm, are taken for that wide, so that parts are no
/// thinner; what comes closer to a corner than half of that goes through the corner. No cut makes an angle below 0.6
/// degrees, but in elements that have less than twice that already.
///
/// problem  its patches are those of the mesh, or its leaves as they were.
/// E        N x channels, irradiance of the mesh's leaves, roughly; of all light [W/m2].
ShadowEdges cut_shadow_edges(ElementMesh& mesh, const Problem& problem, const Field& E,
                             const ShadowEdgeOptions& options, const Monitor& monitor = {});

}  // namespace clerestory
