#pragma once
// The length unit of an IFC file, where Assimp does not know it.

#include <optional>
#include <string_view>

namespace clerestory {

/// Metres of a length unit that is defined by conversion (feet, inches): Assimp 5.2 takes one for a metre. Nothing when
/// the file uses metres with or without an SI prefix, which Assimp scales itself.
std::optional<double> converted_ifc_unit(std::string_view step_file);

}  // namespace clerestory
