#pragma once
// Sensor CSV -> points.

#include <filesystem>

#include "solver/model/sensors.h"

namespace clerestory {

inline constexpr std::size_t kMaxSensors = 10'000'000;  ///< of one scene

/// Reads rows of x,y,z,nx,ny,nz [m], scene frame; normals of any length. Commas, semicolons, tabs and blanks separate,
/// so that the .pts files of Radiance's world are read; with one of the others a comma may be the decimal one. Lines
/// end in LF, CR LF or CR. The first row may be a header, which may also put the columns in another order. Blank lines
/// and lines that start with # are skipped.
///
/// returns  one point a row, normals of length 1; the set is called after the file.
/// throws   InputError naming file and row.
SensorSet read_sensors(const std::filesystem::path& file);

}  // namespace clerestory
