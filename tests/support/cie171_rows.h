#pragma once
// Rows of ../shared/reference/cie171.csv, where that folder lies beside the checkout.

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "solver/model/vec.h"
#include "tests/support/csv_rows.h"

namespace clerestory::test {

struct Cie171Row {
  std::string test_case, config, point;
  Vec3 sun, position, normal;  ///< sun: unit, to the sun; zero where the row has none
  std::string quantity;
  double value = 0;
};

inline std::vector<Cie171Row> cie171_rows(const std::string& test_case) {
  std::ifstream file(std::filesystem::path(CLERESTORY_SOURCE_DIR) / ".." / "shared" / "reference" / "cie171.csv");
  std::vector<Cie171Row> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = csv_cells(line);
    if (cells.size() < 13 || cells[0] != test_case) continue;
    const auto number = [&](std::size_t k) { return cells[k].empty() ? 0.0 : std::stod(cells[k]); };
    Cie171Row row{
        cells[0],  cells[1],  cells[3], {}, {number(4), number(5), number(6)}, {number(7), number(8), number(9)},
        cells[10], number(12)};
    if (!cells[2].empty()) {
      std::size_t x = 0, y = 0;
      row.sun.x = std::stod(cells[2], &x);
      row.sun.y = std::stod(cells[2].substr(x), &y);
      row.sun.z = std::stod(cells[2].substr(x + y));
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace clerestory::test
