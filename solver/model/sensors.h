#pragma once
// Points where irradiance is asked for, and what is told of them.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

/// What the sensors of a set measure. All but the cylindrical ones are planes, whose normals the reader has set:
/// horizontal ones face up, vertical ones have horizontal normals, camera ones face a camera.
enum class SensorKind { planar, horizontal, vertical, cylindrical, camera };

/// In the order of the enumerators.
inline constexpr std::string_view kSensorKindNames[] = {"planar", "horizontal", "vertical", "cylindrical", "camera"};

struct SensorPoint {
  Vec3 position;  ///< [m]
  Vec3 normal;    ///< unit; of a cylindrical sensor its axis
};

/// A named list of points, from a CSV file or a grid.
struct SensorSet {
  std::string name;
  std::vector<SensorPoint> points;
  SensorKind kind = SensorKind::planar;
  std::optional<double> threshold{};      ///< illuminance that points should have [lx]
  std::optional<double> area_of_point{};  ///< that each stands for, of a grid [m2]
};

/// Planes around the axis of a cylindrical sensor, see solver/evaluate/sensor_planes.h.
inline constexpr std::size_t kCylinderPlanes = 21;

/// How many planes a sensor of this kind takes.
constexpr std::size_t planes_a_sensor(SensorKind kind) { return kind == SensorKind::cylindrical ? kCylinderPlanes : 1; }

/// The points of all sets, one set after the other.
inline std::vector<SensorPoint> all_sensor_points(const std::vector<SensorSet>& sets) {
  std::vector<SensorPoint> points;
  for (const SensorSet& set : sets) points.insert(points.end(), set.points.begin(), set.points.end());
  return points;
}

/// The illuminances of one set in a few figures.
struct SensorSummary {
  std::string name;
  SensorKind kind = SensorKind::planar;
  std::size_t points = 0;
  double mean = 0, min = 0, max = 0, median = 0;  ///< [lx]
  double uniformity = 0;                          ///< U0 = min / mean [1]; 0 where it is dark
  struct Threshold {
    double lux = 0;
    double share = 0;  ///< of the points at or above it [1]
  };
  std::optional<Threshold> threshold{};
  struct DaylightFactor {
    double mean = 0, median = 0;  ///< [%]
    double share = 0;             ///< of the points with 2 % or more [1]
  };
  std::optional<DaylightFactor> daylight_factor{};
};

}  // namespace clerestory
