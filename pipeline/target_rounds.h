#pragma once
// The rounds that a target error may take, and what each is expected to reach and to cost.

#include <array>
#include <cstddef>

#include "solver/model/method.h"

namespace clerestory {

/// A level, and how often its effort is raised: each time elements of half the area and twice the rays.
struct TargetRound {
  Accuracy accuracy;
  int tighten;
  // Times those of a draft: geometric means over shipped scenes, each within a factor of two (docs/accuracy.md).
  double error;     ///< in the worst room
  double time;      ///< of the whole round
  double elements;  ///< and points
};

/// From coarse to fine.
inline constexpr std::array<TargetRound, 5> kTargetRounds{{{Accuracy::draft, 0, 1, 1, 1},
                                                           {Accuracy::standard, 0, 0.45, 3.3, 4.2},
                                                           {Accuracy::fine, 0, 0.28, 11, 11},
                                                           {Accuracy::fine, 1, 0.2, 25, 22},
                                                           {Accuracy::fine, 2, 0.15, 60, 44}}};

/// The first round behind `now` that is expected to reach the target; the next one where none is.
///
/// error  of the round `now` [1].
std::size_t round_for(double target, std::size_t now, double error);

}  // namespace clerestory
