#pragma once
// Glowing panels that hardly light the room they hang in.

#include <string>
#include <vector>

#include "solver/illumination/problem.h"

namespace clerestory {

/// One line a material, by its name:
/// - of one side, and that one is turned to what lies right behind the panel, to a solid or to nothing, while its black
///   side faces the room;
/// - of two sides, one of which lies within a few centimetres of something else: half of its light is spent there.
///
/// Needs triangles with their materials and the rays; sides need not take part. Cost: 2048 rays a glowing material.
std::vector<std::string> hints_about_panels(const Problem& problem);

}  // namespace clerestory
