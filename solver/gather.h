#pragma once
// Irradiance at vertices and sensors, from a solved field.

#include <cstdint>
#include <span>
#include <vector>

#include "solver/gather_pattern.h"
#include "solver/model/monitor.h"
#include "solver/model/sensors.h"
#include "solver/model/solution.h"
#include "solver/model/vertex_lightmap.h"
#include "solver/problem.h"
#include "solver/solve.h"

namespace clerestory {

/// Rays of a vertex.
GatherQuality vertex_quality(const SolveOptions& options);

/// Irradiance [W/m2] at points, P x channels.
struct PointIrradiance {
  Field E;
  Field std_error;  ///< of E; empty unless the method is `path`
  unsigned long long rays = 0;
  bool complete = true;  ///< false: stopped early, the remaining points hold 0
};

/// At each sensor point itself, by gather_point(); `path` estimates it by paths instead.
///
/// points  positions in the scene's frame.
/// Cost    0.1 (draft) to 2 ms (fine) a point and core.
PointIrradiance gather_at_sensors(const Problem& problem, const Solution& solution, std::span<const SensorPoint> points,
                                  const SolveOptions& options, const Monitor& monitor = {});

/// Fills lightmap.E (and std_error for `path`) with the irradiance at each point's sample position. A point that was
/// not reached when the monitor stopped keeps what lightmap.E held: fill it with average_to_points() before. returns
/// rays traced.
unsigned long long gather_at_points(const Problem& problem, const Solution& solution, VertexLightmap& lightmap,
                                    const SolveOptions& options, const Monitor& monitor = {});

/// Numbers of the points that lie inside a solid: most of what they see are sides that no light reaches.
std::vector<std::size_t> buried_points(const Problem& problem, std::span<const SensorPoint> points);

}  // namespace clerestory
