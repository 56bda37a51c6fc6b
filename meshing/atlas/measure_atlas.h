#pragma once
// What a viewer will see of an atlas, against what it was made of.

#include "solver/model/lightmap_atlas.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// Looks the first channel up as a viewer does, at four points a cell, on all edges and points.
AtlasError measure_atlas(const WrittenResult& result, const Field& value, const LightmapAtlas& atlas);

}  // namespace clerestory
