#pragma once
// Counts and quality of a mesh.

#include "meshing/surface_complex.h"
#include "solver/model/mesh_report.h"
#include "solver/model/patch_set.h"

namespace clerestory {

/// Edges of one face, and of more than two, before anything is joined.
void count_edges(const FaceComplex& complex, MeshReport& report);

/// Number, edges and angles of the triangles.
void measure_quality(const PatchSet& patches, MeshReport& report);

}  // namespace clerestory
