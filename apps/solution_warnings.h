#pragma once
// What a solve warned of, for who makes something of its result.

#include "apps/console.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// Warns again of what the result's own solve warned of, the last three: a picture of light that cannot be trusted
/// looks like any other.
void repeat_warnings(const WrittenResult& result, Console& console);

}  // namespace clerestory
