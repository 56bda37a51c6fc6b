#pragma once
// What a person should know of a result before using it.

#include "pipeline/observer.h"
#include "pipeline/solved.h"

namespace clerestory {

/// Light that went missing or was made, more than 1 % of it, and a measured error above what the accuracy stands for
/// (accuracy.h: what may lie between vertices). Of laws that were checked those that do not hold, with the room.
void warn_about_result(const Solved& solved, Observer& observer);

}  // namespace clerestory
