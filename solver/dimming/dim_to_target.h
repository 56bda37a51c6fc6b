#pragma once
// Dim levels that light sensors as asked for, at the least flux.

#include <optional>
#include <span>
#include <vector>

namespace clerestory {

inline constexpr double kLeastTarget = 0.01;  ///< [lx]; far below it a programme has numbers of very different size

/// Light that the sensors of a grid should have: their mean, or the least of them.
struct DimTarget {
  double lux = 0;  ///< kLeastTarget or more
  bool of_minimum = false;
  std::vector<double> given;                  ///< S, from what is not dimmed [lx], >= 0
  std::vector<std::vector<double>> of_layer;  ///< D x S, from each layer at level 1 [lx], >= 0
};

struct DimLevels {
  enum class Outcome { reached, too_dark, too_uneven };
  Outcome outcome = Outcome::reached;
  /// D, 0 to `most`. Reached: those of the least flux. Too dark: all at `most`. Too uneven: those of the best
  /// uniformity.
  std::vector<double> level;
  double best_uniformity = 0;  ///< least over mean, of the worst grid; told where it is too uneven
};

/// Minimises sum over layers of flux_k d_k with 0 <= d_k <= most, so that each target has at least its lux and, where a
/// uniformity is asked for, the least sensor of each target has uniformity x the mean of its grid: a linear programme.
/// Light that is given may be enough already; then all levels are 0, or what uniformity needs.
///
/// flux_lm     of each layer at level 1 [lm], D values >= 0
/// uniformity  0..1
/// Cost: one linear programme of as many rows as there are sensors; about fifteen where it is too uneven.
DimLevels dim_to_target(std::span<const double> flux_lm, std::span<const DimTarget> targets,
                        std::optional<double> uniformity = {}, double most = 1);

/// What the target is of, the mean of its sensors or the least of them, at these levels [lx].
double light_at(const DimTarget& target, std::span<const double> level);

}  // namespace clerestory
