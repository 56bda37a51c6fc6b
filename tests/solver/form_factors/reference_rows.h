#pragma once
// Rows of ../shared/reference/form_factors.csv, where that folder lies beside the checkout.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "solver/model/vec.h"
#include "tests/support/csv_rows.h"

namespace clerestory::test {

using Polygon = std::vector<Vec3>;

struct ReferenceRow {
  std::string id, family, params, quantity;
  double value = 0;
  Polygon polygon1, polygon2;
  std::vector<Polygon> occluders;
};

/// "x y z; x y z; ..."
inline Polygon read_polygon(std::string text) {
  for (char& c : text)
    if (c == ';') c = ' ';
  std::istringstream in(text);
  Polygon polygon;
  for (Vec3 v; in >> v.x >> v.y >> v.z;) polygon.push_back(v);
  return polygon;
}

/// The three numbers after "key=" among `params`.
inline Vec3 read_vector(const std::string& params, const std::string& key) {
  const std::size_t at = (";" + params).find(";" + key + "=");
  if (at == std::string::npos) return {};
  std::istringstream in(params.substr(at + key.size() + 1));
  Vec3 v;
  in >> v.x >> v.y >> v.z;
  return v;
}

inline std::filesystem::path reference_file() {
  return std::filesystem::path(CLERESTORY_SOURCE_DIR) / ".." / "shared" / "reference" / "form_factors.csv";
}

inline std::vector<ReferenceRow> reference_rows() {
  std::vector<ReferenceRow> rows;
  std::ifstream file(reference_file());
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = csv_cells(line);
    if (cells.size() < 11) continue;
    ReferenceRow row{
        cells[0], cells[1], cells[2], cells[3], std::stod(cells[4]), read_polygon(cells[8]), read_polygon(cells[9]),
        {}};
    std::istringstream occluders(cells[10]);
    for (std::string one; std::getline(occluders, one, '|');) row.occluders.push_back(read_polygon(one));
    rows.push_back(row);
  }
  return rows;
}

}  // namespace clerestory::test
