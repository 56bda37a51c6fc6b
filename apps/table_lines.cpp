#include "apps/table_lines.h"

#include <algorithm>

namespace clerestory {
namespace {

/// Characters of UTF-8.
std::size_t width(const std::string& s) {
  return static_cast<std::size_t>(std::ranges::count_if(s, [](char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace

std::vector<std::string> table_lines(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widest(rows.empty() ? 0 : rows.front().size());
  for (const auto& row : rows)
    for (std::size_t k = 0; k < row.size(); ++k) widest[k] = std::max(widest[k], width(row[k]));
  std::vector<std::string> lines;
  for (const auto& row : rows) {
    std::string line = row[0] + std::string(widest[0] - width(row[0]), ' ');
    for (std::size_t k = 1; k < row.size(); ++k) line += std::string(2 + widest[k] - width(row[k]), ' ') + row[k];
    lines.push_back(line);
  }
  return lines;
}

}  // namespace clerestory
