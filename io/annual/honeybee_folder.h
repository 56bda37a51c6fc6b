#pragma once
// --honeybee: the folder of a year's results that Ladybug Tools and Pollination read.

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/annual/npy_file.h"

namespace clerestory {

/// Windows whose light is kept apart, with what their blinds may do: the first state is open.
struct HoneybeeLightPath {
  std::string name;
  std::vector<std::string> states;
};
/// All windows without blinds.
inline const HoneybeeLightPath kStaticApertures = {"__static_apertures__", {"default"}};

struct HoneybeeGrid {
  std::string name;
  std::size_t points = 0;
  std::vector<HoneybeeLightPath> light_paths{kStaticApertures};  ///< that it has light by; their sum is all of it
};

/// By point of a grid [%].
struct HoneybeeMetrics {
  std::vector<double> da, cda, udi, udi_lower, udi_upper;
};

/// FOLDER/<light path>/<state>/{total,direct}/GRID.npy, floats points x hours, grid_states.json, sun-up-hours.txt,
/// study_info.json, metrics/{da,cda,udi,udi_lower,udi_upper}/GRID.{da,cda,udi}, and grids_info.json, without which the
/// folder is not read: it is removed first and written last. Grids whose names are no names of files get others.
/// Source: honeybee-radiance-postprocess, results/results.py and results/annual_daylight.py, as of 2024.
class HoneybeeFolder {
 public:
  /// hours  H hours of the year with light, 0 to 8759.
  /// throws  InputError when it cannot be written there.
  HoneybeeFolder(const std::filesystem::path& folder, std::span<const int> hours, std::vector<HoneybeeGrid> grids);

  /// The next points of a grid by one of its light paths in one of the states: rows of H illuminances of all light and
  /// of direct sun [lx]. A file is closed when it has all rows.
  void add(std::size_t grid, std::size_t light_path, std::size_t state, std::span<const float> total,
           std::span<const float> direct);
  /// metrics  by grid. All rows of all grids were given.
  void commit(std::span<const HoneybeeMetrics> metrics);

 private:
  struct Rows {
    AtomicFile total_file, direct_file;
    NpyRows total, direct;
    std::size_t missing;  ///< rows

    Rows(const std::filesystem::path& folder, const std::string& file, std::size_t points, std::size_t hours)
        : total_file(folder / "total" / file),
          direct_file(folder / "direct" / file),
          total(total_file, points, hours),
          direct(direct_file, points, hours),
          missing(points) {}
  };

  std::filesystem::path folder_;
  std::size_t hours_;
  std::vector<HoneybeeGrid> grids_;
  std::vector<std::string> ids_;  ///< by grid, fit for names of files
  std::map<std::array<std::size_t, 3>, std::unique_ptr<Rows>> open_;
};

}  // namespace clerestory
