#pragma once
// Path tracing as a method: every patch and point on its own, without bias. Slow, and the judge of the others.

#include "solver/illumination/direct.h"
#include "solver/model/monitor.h"
#include "solver/model/solution.h"
#include "solver/spaces/closure.h"

namespace clerestory {

struct PathOptions {
  int paths = 256;  ///< from each patch or point
  std::uint64_t seed = 1;
};

/// Mean irradiance of every patch from paths that start all over it, and its standard error. Paths are added in rounds,
/// so a run that is stopped has fewer of them everywhere.
///
/// direct, closure  only for the energy balance.
Solution path_trace(const Illumination& light, const DirectLight& direct, const Closure& closure,
                    const PathOptions& options, const Monitor& monitor = {});

}  // namespace clerestory
