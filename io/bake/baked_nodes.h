#pragma once
// Parts that .glb files with light have in common. JSON shows: for .cpp files of io/bake/ only.

#include <cstddef>
#include <vector>

#include "io/bake/baked_files.h"
#include "io/bake/glb_builder.h"
#include "solver/model/channels.h"

namespace clerestory {

/// Adds a material that viewers show without lamps of their own.
std::size_t add_unlit(GlbBuilder& glb, nlohmann::json material);

/// COLOR_0: three numbers from 0 to 1 a vertex.
std::vector<float> shown_colours(const Field& shown, double exposure);

/// A node and a mesh for each surface, positions relative to `origin` in the scene's frame. Returns the nodes.
std::vector<std::size_t> add_baked_nodes(GlbBuilder& glb, const BakedMesh& mesh, const BakedNames& names,
                                         const GlbLook& look, const Vec3& origin);

}  // namespace clerestory
