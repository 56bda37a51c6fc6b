#pragma once
// How wrong the written field is, measured and not assumed.

#include <cstdint>

#include "solver/gather.h"

namespace clerestory {

/// Relative to the mean of the reference, see DESIGN: sqrt(mean((x - r)^2)) / mean(r), reference noise taken out.
struct MeasuredError {
  double rms_relative = 0;
  double p95_relative = 0;
  std::size_t samples = 0;  ///< 0: stopped before anything was measured
  double confidence = 0;    ///< half-width of the 95 % interval of rms_relative
};

/// Compares the lightmap (linear between its points) with path tracing at random points of the surfaces.
MeasuredError measure_error(const Problem& problem, const VertexLightmap& lightmap, const SolveOptions& options,
                            const Monitor& monitor = {});

/// Compares sensor values with path tracing at the sensor points; at an even choice of 128 (draft) to 512 (fine) of
/// them where there are more.
MeasuredError measure_sensor_error(const Problem& problem, std::span<const SensorPoint> points, const Field& E,
                                   const SolveOptions& options, const Monitor& monitor = {});

}  // namespace clerestory
