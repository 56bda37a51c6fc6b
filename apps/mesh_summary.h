#pragma once
// What meshing found and did, in words.

#include "apps/console.h"
#include "solver/model/mesh_report.h"

namespace clerestory {

/// Extent, repairs that were needed (only those), and the quality of the triangles.
void say_mesh(const MeshReport& report, Console& console);

}  // namespace clerestory
