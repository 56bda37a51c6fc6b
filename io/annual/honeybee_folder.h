#pragma once
// --honeybee: the folder of a year's results that Ladybug Tools and Pollination read.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/annual/npy_file.h"

namespace clerestory {

struct HoneybeeGrid {
  std::string name;
  std::size_t points = 0;
};

/// By point of a grid [%].
struct HoneybeeMetrics {
  std::vector<double> da, cda, udi, udi_lower, udi_upper;
};

/// FOLDER/__static_apertures__/default/{total,direct}/GRID.npy, floats points x hours, grid_states.json,
/// sun-up-hours.txt, study_info.json, metrics/{da,cda,udi,udi_lower,udi_upper}/GRID.{da,cda,udi}, and grids_info.json,
/// without which the folder is not read. All files appear together; until then those of an older run stand. Each grid
/// has seven files open. Grids whose names are no names of files get others.
/// Source: honeybee-radiance-postprocess, results/results.py and results/annual_daylight.py, as of 2024.
class HoneybeeFolder {
 public:
  /// hours  H hours of the year with light, 0 to 8759.
  /// throws  InputError when it cannot be written there.
  HoneybeeFolder(const std::filesystem::path& folder, std::span<const int> hours, std::vector<HoneybeeGrid> grids);

  /// The next points of a grid: rows of H illuminances of all light and of direct sun [lx].
  void add(std::size_t grid, std::span<const float> total, std::span<const float> direct);
  /// metrics  by grid. All rows of all grids were given.
  void commit(std::span<const HoneybeeMetrics> metrics);

 private:
  Outputs files_;
  std::vector<NpyRows> total_, direct_;  ///< by grid
  std::vector<AtomicFile*> metrics_;     ///< grid after grid
};

}  // namespace clerestory
