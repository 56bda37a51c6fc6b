#pragma once
// Points of a plane -> the lattice that they are part of.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace clerestory {

struct PlanPoint {
  double x = 0, y = 0;  ///< [m], y up
};

/// Values on places origin + column u + row v.
struct Lattice {
  PlanPoint origin, u, v;  ///< u, v: to the next column and row, v counter-clockwise from u
  std::size_t columns = 0, rows = 0;
  std::vector<double> value;  ///< row by row; not a number where there is no point

  PlanPoint place(double column, double row) const {
    return {origin.x + column * u.x + row * v.x, origin.y + column * u.y + row * v.y};
  }
};

/// In any order, with holes; two or more in each direction. Nothing when the points lie otherwise, by more than a
/// hundredth of their distance, or so far apart that most places were empty.
std::optional<Lattice> lattice_of(std::span<const PlanPoint> points, std::span<const double> value);

}  // namespace clerestory
