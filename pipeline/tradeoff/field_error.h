#pragma once
// How far a written result is off the reference of a sweep.

#include <cstddef>
#include <string>
#include <vector>

#include "io/read_result.h"
#include "pipeline/tradeoff/sweep_reference.h"
#include "solver/evaluate/error_figures.h"

namespace clerestory {

struct FieldValues {
  std::vector<double> E;      ///< [lx] by point of the reference, linear between the points of the result
  std::size_t not_shown = 0;  ///< points where the result has no surface that faces that way; E is 0 there
};

/// The result at the points of the reference, as ParaView shows it: on the nearest triangle that faces the same way.
///
/// tolerance  how far that may be: both surfaces are approximations of the one that was read [m].
/// Cost: points times triangles, about a nanosecond each.
FieldValues values_at(const std::vector<ReferencePoint>& points, const WrittenResult& result, double tolerance);

struct FieldError {
  ErrorFigures all;  ///< of all surfaces
  ErrorFigures
      worst;  ///< of the room with the largest rms, among those that count by themselves and that the reference tells
  std::uint32_t room = 0;
};

/// E against the reference as it is now.
FieldError error_of(const SweepReference& reference, const std::vector<double>& E);

}  // namespace clerestory
