#pragma once
// A result -> a texture lightmap.

#include "solver/model/baked_mesh.h"
#include "solver/model/lightmap_atlas.h"
#include "solver/model/monitor.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// Charts (find_charts.h), their places (pack_charts.h), their texels (fit_texels.h), and how far off lookups are
/// (measure_atlas.h). Channels are illuminance [lx] and what BakedMesh::shown is.
///
/// texels_per_metre  > 0
/// returns           nothing of use when the monitor stopped it.
/// throws            InputError when no picture of 16384 x 16384 texels holds it; the message tells what one would.
/// Threads: same bits for any thread count.
LightmapAtlas make_atlas(const WrittenResult& result, double texels_per_metre, const Monitor& monitor = {});

/// The mesh with places in the atlas: vertices that several charts have are repeated.
///
/// mesh  whose triangles are the result's, in its order.
BakedMesh with_atlas(const BakedMesh& mesh, const LightmapAtlas& atlas);

}  // namespace clerestory
