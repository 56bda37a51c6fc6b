#pragma once
// Solution -> a result as it stands in its file.

#include "solver/model/layered_light.h"
#include "solver/model/patch_set.h"
#include "solver/model/scene_around.h"
#include "solver/model/solution.h"
#include "solver/model/vertex_lightmap.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// All but file, texts, figures and report, which tell of the run.
///
/// layers  of around.layers, in that order; empty where there are none.
/// throws  std::runtime_error when a value is no number that a float holds: our own mistake, and nobody shall see it.
WrittenResult as_written(const PatchSet& patches, const VertexLightmap& lightmap, const Solution& solution,
                         const SceneAround& around, const LayeredLight& layers);

/// illuminance [lx] of irradiance [W/m2], luminance [cd/m2] of radiosity [W/m2], a value a row.
WrittenArray illuminance_of(const WrittenArray& irradiance);
WrittenArray luminance_of(const WrittenArray& radiosity);

}  // namespace clerestory
