#pragma once
// Sensors as the planes on which irradiance is gathered: one each, but for cylindrical ones.

#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/channels.h"
#include "solver/model/sensors.h"

namespace clerestory {

/// The planes of all sensors; those of sensor s are planes[begin[s]] .. planes[begin[s + 1] - 1].
struct SensorPlanes {
  std::vector<SensorPoint> planes;
  std::vector<std::uint32_t> begin{0};

  std::size_t sensor_count() const { return begin.size() - 1; }
};

/// What a vertical cylinder receives is the mean over all planes that stand around its axis,
///   E_z = 1/(2 pi) * integral of E(phi) dphi = 1/pi * integral of L sin(theta) dOmega,   theta from the axis
/// (EN 12464-1, EN 12665), here over kCylinderPlanes of them, evenly spaced.
///
/// Their number N is odd: cos^+ has no odd harmonics but the first, so N planes err like 2 N, for a single point light
/// by up to 1 - x / tan(x) = 0.19 %, x = pi / (2 N), for light from a sky or walls by nothing to speak of.
SensorPlanes planes_of(std::span<const SensorSet> sets);

/// The mean over each sensor's planes, S x channels (or lanes), of the irradiance E on all planes.
Field mean_over_planes(const SensorPlanes& sensors, const Field& E);

/// Numbers of the sensors most of whose planes are in `planes`, ascending.
std::vector<std::size_t> sensors_of(const SensorPlanes& sensors, std::span<const std::size_t> planes);

}  // namespace clerestory
