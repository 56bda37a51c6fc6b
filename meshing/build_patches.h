#pragma once
// Scene -> patches: repairs the surfaces and meshes them.

#include <optional>

#include "solver/model/mesh_report.h"
#include "solver/model/monitor.h"
#include "solver/model/patch_set.h"
#include "solver/model/scene.h"

namespace clerestory {

struct MeshOptions {
  std::optional<double> max_element;      ///< longest edge [m]; default: chosen so that about target_triangles result
  std::optional<double> detail{};         ///< no surface is simplified by more [m]; default: by the longest edge
  double target_triangles = 6000;         ///< for the default of max_element; fine detail of the model may need more
  std::optional<double> fit_triangles{};  ///< edges may be longer, until there are about so few triangles
};

struct MeshedScene {
  PatchSet patches;  ///< both sides of every triangle but of glass and mirrors; dark sides are dropped later, by rays
  MeshReport report;
};

/// Welds, drops and joins faces, imprints contacts between surfaces, and meshes planar regions by constrained Delaunay
/// refinement; curved detail keeps its triangles.
///
/// returns  conforming triangles: no vertex lies inside another triangle's edge.
/// throws   InputError when nothing with an area is left, naming the file and what was dropped.
MeshedScene build_patches(const Scene& scene, const MeshOptions& options = {}, const Monitor& monitor = {});

}  // namespace clerestory
