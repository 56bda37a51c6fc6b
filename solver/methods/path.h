#pragma once
// Paths as a method: every patch and point on its own, without bias. Slow, and the judge of the others.

#include <string_view>

#include "solver/illumination/direct.h"
#include "solver/model/monitor.h"
#include "solver/model/solution.h"
#include "solver/paths/path_tracer.h"
#include "solver/spaces/closure.h"

namespace clerestory {

struct PathOptions {
  int paths = 256;  ///< from each patch or point
  std::uint64_t seed = 1;
  const Field* caustics = nullptr;  ///< null, or N x channels: irradiance that paths do not find, added [W/m2]
};

/// Mean irradiance of every patch from paths that start all over it, and its standard error. Paths are added in rounds,
/// so a run that is stopped has fewer of them everywhere.
///
/// estimator        on the same patches; name: of the method that it is.
/// direct, closure  only for the energy balance.
Solution path_trace(const Problem& problem, const PathEstimator& estimator, std::string_view name,
                    const DirectLight& direct, const Closure& closure, const PathOptions& options,
                    const Monitor& monitor = {});

}  // namespace clerestory
