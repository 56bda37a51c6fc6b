#pragma once
// Light that two kinds of rays find, and which of them it counts for.

namespace clerestory {

/// Weight of what one estimator finds, from the densities (rays per solid angle) of both at that direction. Those of
/// both sum to 1; 1 where the other never goes. Source: Veach & Guibas, "Optimally combining sampling techniques for
/// Monte Carlo rendering", 1995.
inline double balance_heuristic(double own, double other) { return other > 0 ? own / (own + other) : 1; }

/// The same with exponent 2, as weight for each unit of `own`: nearer to the better of both.
inline double power_heuristic_over_density(double own, double other) {
  const double squares = own * own + other * other;
  return squares > 0 ? own / squares : 0;
}

}  // namespace clerestory
