#include "solver/evaluate/sensor_planes.h"

#include <cmath>
#include <numbers>

namespace clerestory {

SensorPlanes planes_of(std::span<const SensorSet> sets) {
  SensorPlanes sensors;
  for (const SensorSet& set : sets) {
    const std::size_t count = planes_a_sensor(set.kind);
    for (const SensorPoint& point : set.points) {
      if (set.kind == SensorKind::cylindrical) {
        const Frame around(point.normal);
        for (std::size_t k = 0; k < count; ++k) {
          const double phi = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count);
          sensors.planes.push_back({point.position, around.to_world(std::cos(phi), std::sin(phi), 0)});
        }
      } else {
        sensors.planes.push_back(point);
      }
      sensors.begin.push_back(static_cast<std::uint32_t>(sensors.planes.size()));
    }
  }
  return sensors;
}

Field mean_over_planes(const SensorPlanes& sensors, const Field& E) {
  Field mean(sensors.sensor_count(), E.channels);
  for (std::size_t s = 0; s < mean.size(); ++s) {
    const std::uint32_t begin = sensors.begin[s], end = sensors.begin[s + 1];
    for (std::uint32_t i = begin; i < end; ++i)
      for (int k = 0; k < E.channels; ++k) mean.at(s, k) += E.at(i, k) * (1.0 / (end - begin));
  }
  return mean;
}

std::vector<std::size_t> sensors_of(const SensorPlanes& sensors, std::span<const std::size_t> planes) {
  std::vector<std::size_t> found;
  auto next = planes.begin();
  for (std::size_t s = 0; s < sensors.sensor_count(); ++s) {
    const auto first = next;
    while (next != planes.end() && *next < sensors.begin[s + 1]) ++next;
    if (2 * (next - first) > sensors.begin[s + 1] - sensors.begin[s]) found.push_back(s);
  }
  return found;
}

}  // namespace clerestory
