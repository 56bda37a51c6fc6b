#pragma once
// Where surfaces end in mid-air: the rims of possible openings.

#include <vector>

#include "solver/model/patch_set.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// A plane polygon of air that surfaces surround, corners counter-clockwise around one of its sides.
struct Gap {
  std::vector<Vec3> corners;
  bool is_hole = false;  ///< edges of surfaces run all around it
};

/// Holes in plane surfaces and where a whole wall of sheets is missing, then strips between a rim and what stands
/// opposite of it in the rim's plane; they may overlap.
std::vector<Gap> find_gaps(const PatchSet& patches, const RayScene& rays);

}  // namespace clerestory
