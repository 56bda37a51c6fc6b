#pragma once
// Rows of a CSV file by the names of its header.

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace clerestory::test {

using CsvRow = std::map<std::string, std::string>;

/// Cells may stand in double quotes and hold commas then.
inline std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> out(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      out.emplace_back();
    else if (c != '\r')
      out.back() += c;
  }
  return out;
}

/// Nothing where there is no such file.
inline std::vector<CsvRow> csv_rows(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<CsvRow> rows;
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = csv_cells(line);
  while (std::getline(in, line)) {
    const std::vector<std::string> values = csv_cells(line);
    CsvRow& row = rows.emplace_back();
    for (std::size_t i = 0; i < names.size() && i < values.size(); ++i) row[names[i]] = values[i];
  }
  return rows;
}

}  // namespace clerestory::test
