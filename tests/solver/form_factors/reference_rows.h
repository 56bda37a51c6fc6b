#pragma once
// Rows of tests/reference/form_factors.csv.

#include <sstream>
#include <string>
#include <vector>

#include "solver/model/vec.h"
#include "tests/support/reference_table.h"

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

inline std::vector<ReferenceRow> reference_rows() {
  std::vector<ReferenceRow> rows;
  for (CsvRow& cell : reference_table("form_factors.csv")) {
    ReferenceRow row{cell["id"],
                     cell["family"],
                     cell["params"],
                     cell["quantity"],
                     std::stod(cell["value"]),
                     read_polygon(cell["polygon1"]),
                     read_polygon(cell["polygon2"]),
                     {}};
    std::istringstream occluders(cell["occluders"]);
    for (std::string one; std::getline(occluders, one, '|');) row.occluders.push_back(read_polygon(one));
    rows.push_back(row);
  }
  return rows;
}

}  // namespace clerestory::test
