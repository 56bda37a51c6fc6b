#pragma once
// Rows of ../shared/reference/skies.csv, where that folder lies beside the checkout.

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/csv_rows.h"

namespace clerestory::test {

struct SkyRow {
  std::string group, model, config, quantity;
  double value = 0;
};

inline std::vector<SkyRow> sky_rows(const std::string& group) {
  std::ifstream file(std::filesystem::path(CLERESTORY_SOURCE_DIR) / ".." / "shared" / "reference" / "skies.csv");
  std::vector<SkyRow> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = csv_cells(line);
    if (cells.size() > 5 && cells[0] == group)
      rows.push_back({cells[0], cells[1], cells[2], cells[3], std::stod(cells[5])});
  }
  return rows;
}

/// The number behind `word`, as 30 behind "sun elevation ".
inline double number_behind(const std::string& text, const std::string& word) {
  return std::stod(text.substr(text.find(word) + word.size()));
}

}  // namespace clerestory::test
