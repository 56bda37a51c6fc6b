#pragma once
// A texture lightmap -> EXR, PNG, JSON.

#include "io/atomic_file.h"
#include "solver/model/lightmap_atlas.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// One channel "Y": illuminance [lx].
/// throws  InputError as require_picture_files().
void write_atlas_exr(AtomicFile& file, const LightmapAtlas& atlas);

/// sRGB of what is shown x exposure.
/// throws  InputError as require_picture_files().
void write_atlas_png(AtomicFile& file, const LightmapAtlas& atlas, double exposure);

/// Size, texels per metre, share used, error, and each chart: surface, normal, rectangle, place and step of its texels
/// in the scene, area.
void write_atlas_json(AtomicFile& file, const LightmapAtlas& atlas, const WrittenResult& result);

}  // namespace clerestory
