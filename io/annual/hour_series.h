#pragma once
// --hours: the illuminance of every point in every hour, written block by block and never held whole.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "solver/model/sensors.h"

namespace clerestory {

/// A file or folder under construction. Until commit() nothing of it stands in the place of what was there.
class HourSeries {
 public:
  virtual ~HourSeries() = default;
  /// The next sensors, in their order: rows of H illuminances of all light and of direct sun [lx].
  /// throws  InputError when the disk is full.
  virtual void add(std::span<const float> total, std::span<const float> direct) = 0;
  /// All rows were given.
  virtual void commit() = 0;
};

/// hours  H hours of the year, 0 to 8759, that the columns stand for; all others are dark.
///
/// OUT.h5, .hdf5: one file of HDF5, /hour [H], and of n sensors /sensors/position and /sensors/normal [n x 3],
/// /sensors/total and /sensors/direct [n x H] of floats. Anything else is a folder of NumPy's files, hour.npy,
/// sensors/total.npy and so on.
/// throws  InputError when it cannot be written there, or HDF5's module is not installed.
std::unique_ptr<HourSeries> make_hour_series(const std::filesystem::path& destination, std::span<const int> hours,
                                             std::span<const SensorPoint> sensors);

/// How many bytes it will have, to be said beforehand.
std::size_t bytes_of_series(std::size_t hours, std::size_t sensors);

}  // namespace clerestory
