#pragma once
// How wrong each time of a series is, measured under its own light.

#include <span>
#include <vector>

#include "pipeline/solved.h"
#include "solver/illumination/problem.h"
#include "solver/methods/layered_field.h"

namespace clerestory {

/// What was solved for all times together.
struct SolvedSeries {
  const Problem& problem;  ///< with the mean light, on the elements
  const VertexLightmap& lightmap;
  const Solution& solution;
  const LayeredField& layers;  ///< one a time
};

/// Sensors of a series, those aside whose error says nothing.
struct SensorsOfSeries {
  std::span<const SensorPoint> points;
  std::span<const PointsOfSet> sets;
  const Field& layers;  ///< points x lanes [W/m2]
};

/// Of each time; nothing of those that are dark, and of those that the monitor leaves no time for.
///
/// effort  of one of them.
std::vector<ErrorAtTime> errors_at_times(const SolvedSeries& series, const SensorsOfSeries& sensors,
                                         const ErrorEffort& effort, std::uint64_t seed, const Monitor& monitor);

}  // namespace clerestory
