#pragma once
// Which of the ways to find a path its light counts for.

namespace clerestory {

// A path leads from the receiving point x_0 over surfaces x_1 ... x_m to a light. It may be found from the receiver up
// to any x_(t-1) and from the light down to x_t, joined between, if that part of it may be joined at all; by a shadow
// ray from x_m; or by meeting the light. The density of each way is a product over the parts of the path, and the
// balance heuristic weighs it by its share of the sum over all ways. These sums are carried along either half of the
// path, relative to the way at hand. Source: Veach & Guibas, "Optimally combining sampling techniques for Monte Carlo
// rendering", 1995.

/// The part of a path between x_(i-1) and x_i, by densities per area [1/m2].
struct PathPart {
  double from_eye;    ///< of x_i, for paths that come to x_(i-1) from the receiver
  double from_light;  ///< of x_(i-1), for those that come to x_i from the light
  bool can_join;      ///< false: turned by a mirror or a pane
};

/// All ways that join the path before x_i, relative to reaching x_i from the receiver. sum: the same of x_(i-1); of x_0
/// it is 0.
inline double joints_before(const PathPart& part, double sum) {
  return ((part.can_join ? 1 : 0) + part.from_light * sum) / part.from_eye;
}
/// All ways that reach x_(i-1) from the receiver, relative to reaching it from the light. sum: the same of x_i; of x_m
/// PathEnd::beyond().
inline double joints_beyond(const PathPart& part, double sum) {
  return ((part.can_join ? 1 : 0) + part.from_eye * sum) / part.from_light;
}
/// Of the way that joins this part; before: of x_(i-1), beyond: of x_i.
inline double weight_of_joint(const PathPart& part, double before, double beyond) {
  return 1 / (1 + part.from_light * before + part.from_eye * beyond);
}

/// The last part of a path, between x_m and the light. Densities of its light: per solid angle at x_m, or what else
/// suits the light, the same for all three.
struct PathEnd {
  double met = 0;         ///< of meeting it from x_m
  double shadow_ray = 0;  ///< of choosing it for a shadow ray from x_m
  double from_light = 0;  ///< of sending a particle from it, times that of x_m for that one [1/m2]

  /// All ways to find the path, where x_m is reached from the receiver; before: joints_before() of x_m.
  double all(double before) const { return met + shadow_ray + from_light * before; }
  /// joints_beyond() of x_m.
  double beyond() const { return (met + shadow_ray) / from_light; }
};

}  // namespace clerestory
