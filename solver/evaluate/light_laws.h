#pragma once
// Whether a solution obeys the laws of light.

#include <cstdint>

#include "solver/illumination/problem.h"
#include "solver/model/laws.h"
#include "solver/model/monitor.h"
#include "solver/model/solution.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {

/// E >= 0 on patches and points: how far below 0, as a share of the largest E in the room. Allowed is 1e-4, which
/// sweeps and rounding leave.
LawCheck no_negative_light(const PatchSet& patches, const VertexLightmap& lightmap, const Solution& solution);

/// B = M + rho E + tau E behind, and so B >= rho E: |difference| as a share of the largest B in the room; 1e-9 is
/// allowed.
LawCheck radiosity_from_irradiance(const PatchSet& patches, const Solution& solution);

/// E of a room against what its lights and all of the solution's B bring there, by rays apart from those of the method:
/// |sum A E - (direct + carried)| / sum A E; and the imbalance of emitted = absorbed + escaped, of the "whole scene".
///
/// problem   with the elements that the solution belongs to. unhalved: with the patches that they were halved from, or
/// the
///           same: what lights bring to a room does not hang on the elements.
/// accuracy  what may be off of a room's mean [1]; 4 standard errors of these rays are added, more
///           where few patches tell of them. A room is not resolved
///           where these are more than a quarter of its light.
/// Needs     B as it was used: rays that leave a patch carry A B.
LawCheck energy_of_rooms(const Problem& problem, const Problem& unhalved, const Solution& solution, double accuracy,
                         std::uint64_t seed, const Monitor& monitor = {});

}  // namespace clerestory
