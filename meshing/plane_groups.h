#pragma once
// Which faces lie in one plane.

#include <vector>

#include "meshing/surface_complex.h"

namespace clerestory {

/// Groups faces that lie in one plane and touch (by their boxes): whatever their material, and whichever way they face,
/// so that each thing that can overlap or share an edge within a plane is in one group. Facets of a curved surface stay
/// alone: a group's plane is that of its largest face, and all of a member's corners lie in it within tolerance.
/// Cost: O(F log F). The order of groups follows the size of their largest face.
std::vector<PlaneGroup> group_by_plane(const FaceComplex& complex);

}  // namespace clerestory
