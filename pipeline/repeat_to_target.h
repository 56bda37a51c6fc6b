#pragma once
// Once, or again and finer until a target error is met.

#include <functional>
#include <optional>

#include "pipeline/observer.h"
#include "pipeline/solved.h"
#include "solver/model/monitor.h"

namespace clerestory {

/// One round: settings come as asked for and end as they were in force; nothing when it was interrupted early.
/// seconds: what it takes is added, also when it ends by an exception.
using SolveRound =
    std::function<std::optional<Solved>(Settings& settings, const Monitor& monitor, StageSeconds& seconds)>;

/// Calls round() once, or up to kMostRounds times where there is a target error, each time with elements of half the
/// area and twice the rays. returns the result of least error, with the times of all rounds.
Solved repeat_to_target(const Settings& asked, Observer& observer, const SolveRound& round);

}  // namespace clerestory
