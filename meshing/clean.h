#pragma once
// First step: polygons as read -> triangles without the defects a face has by itself.

#include "meshing/surface_complex.h"
#include "solver/model/mesh_report.h"
#include "solver/model/scene.h"

namespace clerestory {

/// Moves the model to its centre at unit size (in double), drops faces that are not finite, welds vertices,
/// triangulates polygons, drops triangles without area and those that repeat another. Triangles that repeat another
/// with opposite winding are counted and kept: resolve_overlaps gives each its side.
///
/// allowed  what the complex takes for rounding.
/// throws  InputError naming the file and what was dropped when nothing is left.
FaceComplex clean(const Scene& scene, const Tolerance& allowed, MeshReport& report);

}  // namespace clerestory
