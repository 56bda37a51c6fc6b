#pragma once
// A result read back: .vtp -> triangles with their light. VTK stays inside.

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

/// n rows of `components` numbers each.
struct WrittenArray {
  int components = 1;
  std::vector<float> value;
};

/// What write_result() wrote.
struct WrittenResult {
  std::vector<Vec3> points;                                 ///< P, scene's frame [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;      ///< N, points, counter-clockwise from the lit side
  std::map<std::string, WrittenArray> of_points, of_cells;  ///< P and N rows, by name
  std::map<std::string, std::vector<std::string>> texts;    ///< of the field data: material_names, room_names, ...
};

/// throws  InputError when there is no such file, when VTK finds it damaged, when it has other cells than triangles or
///         points that are not there, and when `illuminance` on points is missing: `clerestory solve` did not write it.
WrittenResult read_result(const std::filesystem::path& file);

}  // namespace clerestory
