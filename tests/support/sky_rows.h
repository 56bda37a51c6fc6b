#pragma once
// Rows of tests/reference/skies.csv.

#include <string>
#include <vector>

#include "tests/support/reference_table.h"

namespace clerestory::test {

struct SkyRow {
  std::string group, model, config, quantity;
  double value = 0;
};

inline std::vector<SkyRow> sky_rows(const std::string& group) {
  std::vector<SkyRow> rows;
  for (CsvRow& cell : reference_table("skies.csv"))
    if (cell["group"] == group)
      rows.push_back({cell["group"], cell["model"], cell["config"], cell["quantity"], std::stod(cell["value"])});
  return rows;
}

/// The number behind `word`, as 30 behind "sun elevation ".
inline double number_behind(const std::string& text, const std::string& word) {
  return std::stod(text.substr(text.find(word) + word.size()));
}

}  // namespace clerestory::test
