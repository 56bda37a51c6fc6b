#pragma once
// The default method from patches to a field on vertices: elements halved for transport, then for what is shown.

#include "solver/hierarchy/vertex_field.h"
#include "solver/methods/hierarchical.h"
#include "solver/methods/layered_field.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {

struct HierarchicalFieldOptions {
  HierarchyOptions elements;
  FieldOptions vertices;
  /// Parts of the light, which sum to all of it: with the same rays, the field of each.
  std::span<const Layer> layers{};
};

struct HierarchicalField {
  PatchSet elements;        ///< leaf elements, each on a triangle of its own
  VertexLightmap lightmap;  ///< of the elements, E filled
  Solution solution;        ///< of the elements; energy as the links balanced it
  LayeredField layers;      ///< of HierarchicalFieldOptions::layers
};

/// Solves on a hierarchy, gathers at vertices, and halves elements until straight lines between vertices are good
/// enough. What is gathered there becomes the elements' radiosity, for sensors to gather from; where an element
/// straddles the edge of sun or lamp light, its exact direct flux is kept.
///
/// map  the lightmap of problem.patches.
/// The joint light decides where elements are halved and rays are sent, so it has the same bits with layers as without.
/// Stopped early, vertices not reached show their element's irradiance; Solution::stop tells.
/// Threads: same bits for any thread count.
HierarchicalField hierarchical_field(const Problem& problem, VertexLightmap map,
                                     const HierarchicalFieldOptions& options, const Monitor& monitor = {});

}  // namespace clerestory
