#pragma once
// Hierarchical radiosity: elements, clusters, and links between them.

#include <cstdint>

#include "solver/hierarchy/element_mesh.h"
#include "solver/hierarchy/shortest_edge.h"
#include "solver/illumination/problem.h"
#include "solver/methods/kept_transport.h"
#include "solver/model/hierarchy_debug.h"
#include "solver/model/method.h"
#include "solver/model/monitor.h"
#include "solver/model/solution.h"

namespace clerestory {

/// The defaults are the recommended values; nobody should need others.
struct HierarchyOptions {
  Oracle oracle = Oracle::error;
  int bundle_rays = 256;         ///< from each receiver
  int bright_rays = 128;         ///< pairs with bright sources from each receiver
  double tolerance = 0.1;        ///< of an element's irradiance: it is halved while light varies more inside of it [1]
  ShortestEdge shortest_edge{};  ///< elements are not halved below this
  double residual = 1e-6;        ///< stop when the flux not yet in balance / emitted flux is below this [1]
  std::size_t most_elements = 1'000'000;  ///< no more are made by halving
  std::uint64_t seed = 1;
  HierarchyDebug* debug = nullptr;  ///< filled with the last round that was done
  KeptTransport* keep = nullptr;    ///< filled with the last round, where nothing stopped it
};

/// The leaf elements, and the light on them.
struct HierarchicalSolution {
  PatchSet elements;  ///< ElementMesh::leaf_patches()
  Field delta_light;  ///< N x channels, direct irradiance of sun and luminaires on each leaf [W/m2]; part of
                      ///< solution.E; empty when stopped before the first round
  Solution solution;
};

/// Solves B = M + rho (E_direct + F B) on a tree of elements and clusters (solver/hierarchy/README.md).
///
/// problem  its patches are those the mesh was made of.
/// mesh     is halved where the light asks for it.
/// Stopped before the first round is done, E and B are the ambient estimate, and the log says so.
/// Threads: same bits for any thread count.
HierarchicalSolution hierarchical(const Problem& problem, ElementMesh& mesh, const HierarchyOptions& options = {},
                                  const Monitor& monitor = {});

}  // namespace clerestory
