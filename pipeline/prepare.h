#pragma once
// Scene -> what is solved: surfaces -> patches -> rays -> lights -> sides that light can reach.

#include <optional>

#include "pipeline/observer.h"
#include "pipeline/settings.h"
#include "solver/illumination/problem.h"
#include "solver/model/mesh_report.h"
#include "solver/model/monitor.h"
#include "solver/model/stage_seconds.h"
#include "solver/model/vertex_lightmap.h"
#include "solver/spaces/lit_sides.h"

namespace clerestory {

struct Prepared {
  PatchSet patches;  ///< the sides that light can reach; all of them where the scene has no light
  MeshReport repairs;
  RayScene rays;
  Lights lights;  ///< local frame, with images in mirrors and openings
  LitSides lit_sides;

  /// Valid while this is where it is.
  Problem problem() const { return {patches, rays, lights}; }
};

/// Nothing when interrupted before the patches were complete. seconds: mesh and build are added to.
/// throws  InputError as build_patches().
std::optional<Prepared> prepare(const Scene& scene, const Settings& settings, const Monitor& monitor,
                                StageSeconds& seconds);

/// The same for who looks along rays only: all sides take part, whether light can reach them or not, and there are no
/// openings.
std::optional<Prepared> prepare_for_rays(const Scene& scene, const Settings& settings, const Monitor& monitor);

struct PreparedToSolve {
  Prepared scene;
  VertexLightmap lightmap;  ///< of its patches
};

/// The same with points to show the light on, within the memory limit: with larger elements, and again, until they
/// fit. `settings` end as they are in force: solve.memory_limit is what is left for solve().
///
/// throws  InputError when no light reaches any surface, and when the limit is too low for the model.
std::optional<PreparedToSolve> prepare_to_solve(const Scene& scene, Settings& settings, Observer& observer,
                                                const Monitor& monitor, StageSeconds& seconds);

}  // namespace clerestory
