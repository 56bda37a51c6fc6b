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

/// Calls round() once, or more than once: with a time limit for a draft, which may say that there is time for more
/// (Solved::rather); with a target error by the rounds of target_rounds.h, from a draft on, until it is met, or finer
/// ones do not help, each time saying what the next is expected to cost. returns the result of least error, with the
/// times of all rounds.
Solved repeat_to_target(const Settings& asked, Observer& observer, const SolveRound& round);

}  // namespace clerestory
