#pragma once
// A series of hours as a file of HDF5, by a module of its own.

#include <memory>
#include <vector>

#include "io/annual/hour_series.h"

namespace clerestory {

/// See make_hour_series().
std::unique_ptr<HourSeries> make_hdf5_series(const std::filesystem::path& file, std::span<const int> hours,
                                             std::span<const SensorPoint> sensors);

/// x, y and z of each point's position or normal, one after the other.
std::vector<double> coordinates_of(std::span<const SensorPoint> points, Vec3 SensorPoint::*of);

}  // namespace clerestory
