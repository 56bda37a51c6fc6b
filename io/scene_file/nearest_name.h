#pragma once
// "Did you mean": the known name closest to a mistyped one.

#include <span>
#include <string>
#include <string_view>

namespace clerestory {

/// Edits (insert, drop, replace or swap neighbours) that turn a into b, letter case not counted.
/// Source: Damerau's distance in its restricted form (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// "did you mean 'cie-overcast'?" when a known name is near, else "known are a, b, c", in quotation
/// marks where a name has a blank or a comma.
std::string suggestion(std::string_view mistyped, std::span<const std::string_view> known);

}  // namespace clerestory
