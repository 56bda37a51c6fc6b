#pragma once
// Sensor points and what arrives at them -> CSV.

#include <filesystem>
#include <span>
#include <string>

#include "io/atomic_file.h"
#include "solver/model/channels.h"
#include "solver/model/sensors.h"

namespace clerestory {

/// One row a point, in the order given: x,y,z,nx,ny,nz,illuminance [lx],irradiance_0[,irradiance_1,irradiance_2]
/// [W/m2][,std_error of the illuminance [lx]], each the shortest decimal that reads back as the same number. Into a
/// file that the caller commits, or a whole one.
void write_sensors(AtomicFile& file, std::span<const SensorPoint> points, const Field& E, const Field& std_error = {});
void write_sensors(const std::filesystem::path& file, std::span<const SensorPoint> points, const Field& E,
                   const Field& std_error = {});

/// One row a point: x,y,z,nx,ny,nz and then its figures under their names. value: points x names.
void write_sensor_figures(AtomicFile& file, std::span<const SensorPoint> points, std::span<const std::string> names,
                          std::span<const double> value);

}  // namespace clerestory
