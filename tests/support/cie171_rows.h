#pragma once
// Rows of tests/reference/cie171.csv.

#include <sstream>
#include <string>
#include <vector>

#include "solver/model/vec.h"
#include "tests/support/reference_table.h"

namespace clerestory::test {

struct Cie171Row {
  std::string test_case, config, point;
  Vec3 sun, position, normal;  ///< sun: unit, to the sun; zero where the row has none
  std::string quantity;
  double value = 0;
};

inline std::vector<Cie171Row> cie171_rows(const std::string& test_case) {
  std::vector<Cie171Row> rows;
  for (CsvRow& cell : reference_table("cie171.csv")) {
    if (cell["case"] != test_case) continue;
    const auto number = [&](const char* column) { return cell[column].empty() ? 0.0 : std::stod(cell[column]); };
    Cie171Row row{cell["case"],
                  cell["config"],
                  cell["point"],
                  {},
                  {number("x"), number("y"), number("z")},
                  {number("nx"), number("ny"), number("nz")},
                  cell["quantity"],
                  number("value")};
    std::istringstream(cell["sun_direction"]) >> row.sun.x >> row.sun.y >> row.sun.z;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace clerestory::test
