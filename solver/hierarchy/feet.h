#pragma once
// Elements cut at the feet of what stands on their surface.

#include <cstddef>
#include <limits>

#include "solver/hierarchy/element_mesh.h"
#include "solver/hierarchy/shortest_edge.h"

namespace clerestory {

/// Cuts the edges of leaves' outlines that go from one corner of more than 180 degrees to another, those of a hole that
/// a leg, a post or a small box leaves in a floor, or of the end of a wall: in their middles and at an eighth from both
/// ends. What stands there takes half of the view from all of the edge, and a quarter from its ends: no difference
/// between these tells of it.
///
/// share    of the shortest edge: an edge below it is not cut.
/// most_points  of the mesh: where there are as many none is cut any more.
/// returns  how often an edge was cut.
std::size_t cut_at_feet(ElementMesh& mesh, const ShortestEdge& shortest_edge, double share,
                        std::size_t most_points = std::numeric_limits<std::size_t>::max());

}  // namespace clerestory
