#pragma once
// Irradiance at points, from a solved field: final gather.

#include <cstdint>
#include <span>

#include "solver/model/monitor.h"
#include "solver/model/sensors.h"
#include "solver/model/solution.h"
#include "solver/model/vertex_lightmap.h"
#include "solver/problem.h"
#include "solver/solve.h"

namespace clerestory {

/// Irradiance [W/m2] of each sensor point, gathered at the point itself: lights and bright small sources by shadow
/// rays, the rest by a bundle of stratified directions that looks up B where it lands.
///
/// points   positions in the scene's frame.
/// returns  one value per point, patches.channels channels.
/// Cost     about 0.1 (draft) to 1 ms (fine) a point and core.
Field gather_at_sensors(const Problem& problem, const Solution& solution, std::span<const SensorPoint> points,
                        const SolveOptions& options, const Monitor& monitor = {});

/// Fills lightmap.E with the irradiance gathered at each point's sample position.
void gather_at_points(const Problem& problem, const Solution& solution, VertexLightmap& lightmap,
                      const SolveOptions& options, const Monitor& monitor = {});

/// Points that lie inside a solid or closer to a surface than rays can tell: their numbers, for a warning.
std::vector<std::size_t> buried_points(const Problem& problem, std::span<const SensorPoint> points);

}  // namespace clerestory
