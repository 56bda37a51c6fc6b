#pragma once
// Light that leaves a surface at the points of its lightmap.

#include "solver/model/patch_set.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {

/// B = M + rho E + tau E behind at each point, P x channels [W/m2]; what a diffuser has behind is looked up there,
/// linear between the points of the patch that lies there.
///
/// E  P x channels, at the points [W/m2]. M  N x channels, of the patches [W/m2].
Field radiosity_at_points(const PatchSet& patches, const VertexLightmap& lightmap, const Field& E, const Field& M);

}  // namespace clerestory
