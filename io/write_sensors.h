#pragma once
// Sensor points and what arrives at them -> CSV.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/atomic_file.h"
#include "solver/model/channels.h"
#include "solver/model/sensors.h"

namespace clerestory {

/// What layers give at the sensors.
struct SensorLayers {
  std::vector<std::string> names{};
  Field E{};  ///< points x lanes [W/m2], lane layer * channels + channel
};

/// One row a point, in the order given: x,y,z,nx,ny,nz,illuminance [lx],irradiance_0[,irradiance_1,irradiance_2]
/// [W/m2][,std_error of the illuminance [lx]], then for each layer illuminance:NAME,irradiance_0:NAME[,...], each the
/// shortest decimal that reads back as the same number. A name with a comma is quoted. Into a file that the caller
/// commits, or a whole one.
void write_sensors(AtomicFile& file, std::span<const SensorPoint> points, const Field& E, const Field& std_error = {},
                   const SensorLayers& layers = {});
void write_sensors(const std::filesystem::path& file, std::span<const SensorPoint> points, const Field& E,
                   const Field& std_error = {});

/// One row a point: x,y,z,nx,ny,nz and then its figures under their names. value: points x names.
void write_sensor_figures(AtomicFile& file, std::span<const SensorPoint> points, std::span<const std::string> names,
                          std::span<const double> value);

}  // namespace clerestory
