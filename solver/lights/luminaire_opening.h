#pragma once
// Where on a luminaire's opening light comes from.

namespace clerestory {

/// A place of the unit square, which is laid over the opening, and its weight.
struct OpeningPlace {
  double u = 0.5, v = 0.5, weight = 1;
};

}  // namespace clerestory
