#pragma once
// Detail far below what light needs goes.

#include <span>

#include "meshing/surface_complex.h"
#include "solver/model/material.h"
#include "solver/model/mesh_report.h"
#include "solver/model/monitor.h"

namespace clerestory {

/// Merges facets narrower than 2 `detail` of finely tessellated parts (a railing's tubes, a beam's fillets): vertices
/// go, none moves, and those of rims stay. Surfaces stay within `detail` of where they were, in both directions, and no
/// facet turns by more than 15 degrees, so that what is bent smoothly stays so. Wider facets stay in their planes, and
/// with them what touches. A part whose distance is not shown to be within the bound, or that would lose less than a
/// tenth of its faces stays as it was. Ends with FaceComplex::flat empty, and no face without area.
///
/// detail  [working frame]; 0: nothing is done.
/// Threads: same result for any number.
/// Source: OpenMesh's decimater with quadrics (Garland and Heckbert 1997) for the order of collapses.
void simplify(FaceComplex& complex, std::span<const Material> materials, double detail, MeshReport& report,
              const Monitor& monitor);

}  // namespace clerestory
