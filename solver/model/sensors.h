#pragma once
// Points where irradiance is asked for.

#include <string>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

struct SensorPoint {
  Vec3 position;  ///< [m]
  Vec3 normal;    ///< unit
};

/// A named list of points, from a CSV file or a grid.
struct SensorSet {
  std::string name;
  std::vector<SensorPoint> points;
};

}  // namespace clerestory
