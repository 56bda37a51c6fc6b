#pragma once
// What comparisons at single points say about an error.

#include <cstddef>
#include <cstdint>
#include <span>

namespace clerestory {

/// Relative to the mean of the reference: sqrt(mean((x - r)^2)) / mean(r), reference noise taken out, and the bias
/// (mean(x) - mean(r)) / mean(r). Median, p95 and p99 are relative to each point's own reference.
struct ErrorFigures {
  double rms_relative = 0, median_relative = 0, p95_relative = 0, p99_relative = 0, bias_relative = 0;
  std::size_t samples = 0;  ///< 0: stopped before anything was measured, or no light arrives at any of the points
  double confidence = 0;    ///< half-width of the 95 % interval of rms_relative
  bool bound = false;       ///< the error is below what the references resolve: these are upper bounds, not values

  /// The 95 % interval of rms_relative.
  double upper() const { return bound ? rms_relative : rms_relative + confidence; }
  double lower() const { return bound ? 0 : rms_relative - confidence; }
};

/// One comparison, as luminous means: the value, and what paths say, without bias, with their standard error (of eight
/// replicates); and the area it stands for, in any unit.
struct Comparison {
  double x = 0, r = 0, std_error = 0, weight = 1;
  std::uint32_t part = 0;  ///< room or set of sensors
  /// Two gathers at the point from the solution's radiosity, each with rays of its own; negative: there are none.
  double gather = -1, other_gather = -1;
  double element = -1;  ///< irradiance of the point's element in the solution; negative: not known
  double off_mean = 0;  ///< of x, from its mean over that element
  double albedo = 0;    ///< there
};
/// Paths alone: the noise of the references is taken out of the mean square by its variance, of the percentiles in the
/// same proportion.
///
/// With gathers: these have little noise, and two of them leave none in the mean of (x - g1)(x - g2). What they have in
/// common with the result is its radiosity. Where that is wrong, gathers and elements disagree in the mean, and the
/// error is as much times 1 / (1 - albedo): the residual of the radiosity equation. (How the result varies within
/// elements is nothing in the mean, and taken out.) And paths judge it: by the ratio of all of them to all gathers,
/// which corrects the gathers where it is no chance (and the less readily where it is more than the residual leaves
/// possible), and by how much more they scatter around these than their own noise allows. The smaller of what ratio and
/// residual leave possible is in the confidence. Where most paths find no light, as in a room lit through a crack, they
/// correct nothing, and how far off they are is in the confidence.
///
/// Where paths have less noise than gathers, as where much light is straight from lamps and there are many of them,
/// they are alone.
///
/// Where nothing is left of the mean square beyond what chance may leave, all are upper bounds.
/// Source: U-statistics for the variance of paired estimates (Hoeffding 1948).
ErrorFigures summarise(std::span<const Comparison> comparisons);

}  // namespace clerestory
