#pragma once
// The default method from patches to a field on vertices: elements halved for transport, then for what is shown.

#include <functional>
#include <optional>

#include "solver/gather/gather_time.h"
#include "solver/hierarchy/vertex_field.h"
#include "solver/methods/hierarchical.h"
#include "solver/methods/layered_field.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {

struct HierarchicalFieldOptions {
  HierarchyOptions elements;
  FieldOptions vertices;
  /// Gathers of the caller afterwards that the deadline must leave time for.
  Gathers later{};
  /// Asked once the elements are solved, with the points of the mesh: how to go on at vertices; nothing: not at all.
  std::function<std::optional<FieldOptions>(const Problem& elements, const Solution& solution,
                                            const VertexLightmap& points)>
      goes_on{};
  /// Parts of the light, which sum to all of it: with the same rays, the field of each.
  std::span<const Layer> layers{};
};

struct HierarchicalField {
  PatchSet elements;        ///< leaf elements, each on a triangle of its own
  VertexLightmap lightmap;  ///< of the elements, E filled
  Solution solution;        ///< of the elements; energy as the links balanced it
  LayeredField layers;      ///< of HierarchicalFieldOptions::layers
  bool went_on = true;      ///< as HierarchicalFieldOptions::goes_on said; if not, all of this is empty
};

/// Solves on a hierarchy, gathers at vertices, and halves elements until straight lines between vertices are good
/// enough. What is gathered there becomes the elements' radiosity, for sensors to gather from; where an element
/// straddles the edge of sun or lamp light, its exact direct flux is kept.
///
/// map  the lightmap of problem.patches.
/// The joint light decides where elements are halved and rays are sent, so it has the same bits with layers as without.
/// Stopped early, vertices not reached show their element's irradiance; Solution::stop tells. With a deadline elements
/// get nine tenths of the time, and vertices what they need or what is left, half a second at least.
/// Threads: same bits for any thread count.
HierarchicalField hierarchical_field(const Problem& problem, VertexLightmap map,
                                     const HierarchicalFieldOptions& options, const Monitor& monitor = {});

}  // namespace clerestory
