#pragma once
// The last look at values before anybody sees them.

#include <string_view>

#include "solver/model/channels.h"

namespace clerestory {

/// throws  std::logic_error that names the values, when one of them is no number, infinite, or less than nothing by
/// more
///         than sweeps and rounding leave (1e-4 of the largest). What they leave below nothing becomes 0.
void require_sound(Field& values, std::string_view name);

}  // namespace clerestory
