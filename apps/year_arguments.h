#pragma once
// Options of a year: thresholds, a part, and what of a scene's settings a year follows.

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/console.h"
#include "pipeline/settings.h"

namespace clerestory {

/// "2/4" as its two numbers; nothing where it is no part.
std::optional<std::pair<std::size_t, std::size_t>> part_of(const std::string& words);

/// Why a text is no part; empty when it is one.
std::string problem_with_part(const std::string& words);

/// Why a text is no threshold [lx]; empty when it is one.
std::string problem_with_threshold(const std::string& words);

/// Why thresholds do not go together: two of them would have one name in the files. Empty when they do.
std::string problem_with_thresholds(const std::vector<double>& thresholds);

/// Takes out of the settings what a year does not follow, with a warning for each that the scene's file gives.
void leave_out_what_a_year_does_not_follow(Settings& settings, const std::string& scene_file, Console& console);

}  // namespace clerestory
