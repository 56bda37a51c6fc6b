#pragma once
// What points show of luminaires that are too near for them.

#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/patch_set.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {

/// Beside a luminaire the light peaks between points, or on one: straight lines between them would lose its flux, or
/// make far more of it. Where the mean of a patch's corners is off its E by more than a twentieth, its corners show the
/// mean of the patches around them, weighted by area, which carries the same flux.
///
/// E  N x channels, exact [W/m2]; of: patches near luminaires.
/// returns  the points that were changed.
std::vector<std::uint32_t> carry_flux_to_points(const PatchSet& patches, const Field& E,
                                                std::span<const std::uint32_t> of, VertexLightmap& lightmap);

}  // namespace clerestory
