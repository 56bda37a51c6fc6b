#pragma once
// A table as lines of text.

#include <string>
#include <vector>

namespace clerestory {

/// Rows of as many words, the first column to the left and the others to the right, two blanks between.
std::vector<std::string> table_lines(const std::vector<std::vector<std::string>>& rows);

}  // namespace clerestory
