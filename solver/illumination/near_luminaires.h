#pragma once
// Luminaires close to surfaces: which planes their rays keep clear of, and what they give to patches near by.

#include <vector>

#include "solver/illumination/problem.h"

namespace clerestory {

/// Finds the planes of surfaces so near to each luminaire that float could put it on their other side: a lamp 1 um off
/// a wall is a thousandth of what floats resolve in a hall of 1 km. Which side it is on is decided in double.
///
/// In the very plane of a surface (to double rounding; to float rounding where most of its light goes into the surface,
/// and the side it stands on is open) a luminaire is mounted in it: it shines to either side and gives the surface
/// nothing.
/// Cost: 10 ns a triangle, and what is near.
void find_near_planes(Lights& lights, const PatchSet& patches, const RayScene& rays);

/// Whether any of the luminaires is so near to the patch that points of it do not tell how it is lit; see wants_view().
std::vector<bool> patches_near_luminaires(const PatchSet& patches, const Lights& lights);

}  // namespace clerestory
