#pragma once
// The default method from patches to a field on vertices: elements halved for transport, then for what is shown.

#include "solver/model/hierarchy_debug.h"
#include "solver/model/vertex_lightmap.h"
#include "solver/solve.h"

namespace clerestory {

struct ShownSolution {
  PatchSet elements;        ///< leaf elements, each on a triangle of its own
  VertexLightmap lightmap;  ///< of the elements, E filled
  Solution solution;        ///< of the elements; energy as the links balanced it
};

/// Whether a limit of memory leaves room for a solve on these patches, matrices aside.
bool has_memory_for(const PatchSet& patches, const VertexLightmap& map, const SolveOptions& options);

/// Solves on a hierarchy, gathers at vertices, and halves elements until straight lines between vertices are good
/// enough. What is gathered there becomes the elements' radiosity, for sensors to gather from; where an element
/// straddles the edge of sun or lamp light, its exact direct flux is kept.
///
/// map           the lightmap of problem.patches.
/// longest_edge  of the patches [m]; elements are halved down to a share of it.
/// debug         filled where it is asked for; nothing is computed for it otherwise.
/// Stopped early, vertices not reached show their element's irradiance; Solution::stop tells.
/// Threads: same bits for any thread count.
ShownSolution solve_hierarchical(const Problem& problem, VertexLightmap map, double longest_edge,
                                 const SolveOptions& options, const Monitor& monitor = {},
                                 HierarchyDebug* debug = nullptr);

}  // namespace clerestory
