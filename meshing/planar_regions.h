#pragma once
// Faces of one kind in one plane become polygons with holes.

#include <span>
#include <vector>

#include "meshing/imprint_contacts.h"
#include "meshing/surface_complex.h"
#include "solver/model/material.h"
#include "solver/model/mesh_report.h"

namespace clerestory {

/// Keeps of a drawing only the lines that part something: regions that show different sheets, a region from nothing, or
/// that another plane shares. What is left of each plane are polygons with holes, as few and as long lines as it takes:
/// a vertex in a straight line that nothing else needs goes.
///
/// returns  one domain for each group that shows something, in the groups' order.
std::vector<PlanarDomain> join_planar_regions(FaceComplex& complex, const std::vector<PlaneGroup>& groups,
                                              std::span<const Material> materials, Drawing drawing, MeshReport& report);

}  // namespace clerestory
