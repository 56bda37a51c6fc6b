#pragma once
// Patches -> points to show the solution on.

#include "solver/model/patch_set.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {

/// Shares points between patches where the surface goes on smoothly on that side. Around each edge the sides are taken
/// in angular order: the patch met first when turning off patch p's side over the edge is its neighbour there, so a
/// partition standing on a floor parts the floor, and a sheet's rim parts front from back.
///
/// patches     not halved: `splits` is empty.
/// crease_deg  neighbours whose normals differ by more than this do not share points [deg].
/// returns     E is sized P x channels and zero.
VertexLightmap make_lightmap(const PatchSet& patches, double crease_deg = 30);

}  // namespace clerestory
