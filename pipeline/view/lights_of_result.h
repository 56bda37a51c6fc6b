#pragma once
// The scene of a result, ready for rays to its lamps and suns.

#include <filesystem>
#include <optional>

#include "pipeline/observer.h"
#include "pipeline/prepare.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// result   read from `file`
/// instead  the scene's file now; empty: where it was, or beside the result
/// returns  surfaces as they were solved, and lights with images; empty when interrupted
/// throws   InputError when the result's light is not that of its scene as it stands (of a year, of several times,
/// mixed),
///          or the scene is nowhere, or has other surfaces, materials or lights now
std::optional<Prepared> lights_of_result(const WrittenResult& result, const std::filesystem::path& file,
                                         const std::filesystem::path& instead, const Monitor& monitor);

}  // namespace clerestory
