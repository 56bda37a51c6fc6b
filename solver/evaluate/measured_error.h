#pragma once
// How wrong the written field is, measured and not assumed.

#include <cstddef>
#include <cstdint>
#include <span>

#include "solver/illumination/problem.h"
#include "solver/model/monitor.h"
#include "solver/model/sensors.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {

/// Relative to the mean of the reference: sqrt(mean((x - r)^2)) / mean(r), reference noise taken out.
struct MeasuredError {
  double rms_relative = 0;
  double p95_relative = 0;
  std::size_t samples = 0;  ///< 0: stopped before anything was measured, or no light arrives at any of the points
  double confidence = 0;    ///< half-width of the 95 % interval of rms_relative
};

/// One comparison: value, reference and the reference's standard error (of eight replicates), as luminous means; and
/// the area it stands for, in any unit.
struct Comparison {
  double x = 0, r = 0, std_error = 0, weight = 1;
};
/// The noise of the references is taken out: of the mean square by its variance, of the percentile in the same
/// proportion.
MeasuredError summarise(std::span<const Comparison> comparisons);

/// What a measurement may cost. Paths grow like 1 / (1 - rho): a bright room gets fewer of them, at fewer points, and a
/// wider confidence, rather than hours.
struct ErrorEffort {
  std::size_t points;  ///< before a point gets more than the fewest paths that give a standard error
  int paths;           ///< a point, before there are more points
  double rays;         ///< at least; what the result took asks for more
};

/// Compares the lightmap (linear between its points) with path tracing at random points of the surfaces.
///
/// rays_spent  by the solution so far: a twentieth as many go into the measurement, a tenth of its time, as they are
///             single and go anywhere. From counts and not from time, so that every run measures the same.
MeasuredError measure_error(const Problem& problem, const VertexLightmap& lightmap, const ErrorEffort& effort,
                            unsigned long long rays_spent, std::uint64_t seed, const Monitor& monitor = {});

/// Compares sensor values with path tracing at the sensor points; at an even choice of them where there are many.
MeasuredError measure_sensor_error(const Problem& problem, std::span<const SensorPoint> points, const Field& E,
                                   const ErrorEffort& effort, unsigned long long rays_spent, std::uint64_t seed,
                                   const Monitor& monitor = {});

}  // namespace clerestory
