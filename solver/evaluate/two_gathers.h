#pragma once
// Two estimates of the light at points that have no noise in common.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "solver/illumination/problem.h"
#include "solver/model/monitor.h"
#include "solver/model/point_irradiance.h"
#include "solver/model/solution.h"
#include "solver/sampling/gather_pattern.h"

namespace clerestory {

/// Luminous means [W/m2] at each of `count` points by two gathers from the solution's radiosity, each with rays of its
/// own; empty when the monitor stopped it.
std::vector<std::array<double, 2>> two_gathers(const Problem& problem, const Solution& solution, std::size_t count,
                                               const PointOf& point_of, const GatherQuality& quality, std::uint64_t key,
                                               const Monitor& monitor);

}  // namespace clerestory
