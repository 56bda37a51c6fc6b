#pragma once
// The words that a view is described by, read; each function says what is wrong with them, or nothing.

#include <string>

#include "pipeline/view/view_request.h"

namespace clerestory {

using Problem = std::string;  ///< empty: none

Problem read_place(const std::string& words, std::optional<Vec3>& to);   ///< "1,2.5,-3"
Problem read_size(const std::string& words, int& width, int& height);    ///< "1920x1080", at most 67 million pixels
Problem read_plan(const std::string& words, std::optional<Cut>& to);     ///< "1.2"
Problem read_section(const std::string& words, std::optional<Cut>& to);  ///< "x=2.5", "y=1"
Problem read_range(const std::string& words, std::optional<std::pair<double, double>>& to);  ///< "10:1000"
Problem read_levels(const std::string& words, std::vector<double>& to);                      ///< "100,300,500"

/// What does not go together.
Problem problem_with_view(const ViewRequest& request, bool as_exr);

}  // namespace clerestory
