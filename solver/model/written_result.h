#pragma once
// A result as it stands in its file: what is made of a solution starts here.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "solver/model/material.h"
#include "solver/model/scene_around.h"
#include "solver/model/vec.h"

namespace clerestory {

/// n rows of `components` numbers each.
struct WrittenArray {
  int components = 1;
  std::vector<float> value;
};

/// n rows of `components` numbers each, exactly.
struct WrittenTable {
  int components = 1;
  std::vector<double> value;
};

/// Name of a layer's own array: "irradiance:desk".
inline std::string of_layer(const char* array, const std::string& layer) { return array + (":" + layer); }

/// What write_result() wrote. Of each layer of `around` there are arrays irradiance and illuminance of its name on
/// points and cells; where surfaces glow or pass light on, radiosity too.
struct WrittenResult {
  std::string file;                                         ///< that it was read from, for messages
  std::vector<Vec3> points;                                 ///< P, scene's frame [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;      ///< N, points, counter-clockwise from the lit side
  std::map<std::string, WrittenArray> of_points, of_cells;  ///< P and N rows, by name
  std::map<std::string, std::vector<std::string>> texts;    ///< of the field data: input, settings.method, ...
  std::map<std::string, double> figures;                    ///< numbers of the field data: settings.max_element, ...

  std::vector<std::uint32_t> material, surface;  ///< N, of each triangle
  std::vector<std::uint32_t> room;               ///< N; empty: not known
  std::vector<Material> materials;               ///< no exitance: that is in the light
  std::vector<std::string> surfaces, rooms;      ///< names
  SceneAround around;
  std::string report;  ///< the run's report as JSON, without times and memory

  /// Of a part of a year what io/annual/year_part_tables.h makes of it: JSON, and numbers by name. Others have none.
  std::string year_part;
  std::map<std::string, WrittenTable> year_tables;

  int channels() const { return of_points.at("irradiance").components; }
};

}  // namespace clerestory
