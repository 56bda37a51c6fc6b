#pragma once
// A .vtp as a test wants it: plain numbers. VTK stays inside.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

struct ResultArray {
  int components = 0;
  std::vector<double> values;
};

struct ResultFile {
  std::vector<Vec3> points;
  std::vector<std::array<std::size_t, 3>> triangles;
  std::vector<std::array<std::size_t, 2>> lines;
  std::map<std::string, ResultArray> of_cells, of_points, numbers;  ///< numbers: of the field data
  std::map<std::string, std::vector<std::string>> texts;            ///< of the field data
};

/// throws  std::runtime_error when VTK cannot read it, or it holds anything but triangles and lines.
ResultFile read_result(const std::string& file);

}  // namespace clerestory
