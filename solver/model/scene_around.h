#pragma once
// What is around the surfaces of a result and takes no part in it as patches. Pictures, bakes and pages need it.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "solver/model/channels.h"
#include "solver/model/sensors.h"
#include "solver/model/solution.h"
#include "solver/model/units.h"
#include "solver/model/vec.h"

namespace clerestory {

/// A triangle of glass or of a mirror.
struct PaneTriangle {
  std::array<Vec3, 3> corners;  ///< scene's frame [m]
  std::uint32_t material = 0, surface = 0;
};

/// Radiance by direction [W/(m2 sr)], at the centres of cells of 3 x 3 degrees: kRows rows from the nadir up, each of
/// kColumns from +x over +y. The horizon lies between two rows.
struct SkyTable {
  static constexpr std::size_t kRows = 60, kColumns = 120;
  Field radiance;  ///< kRows x kColumns; empty: no sky

  bool empty() const { return radiance.value.empty(); }
  static Vec3 direction(std::size_t row, std::size_t column) {
    const double elevation = ((static_cast<double>(row) + 0.5) / kRows - 0.5) * std::numbers::pi;
    const double azimuth = (static_cast<double>(column) + 0.5) / kColumns * 2 * std::numbers::pi;
    return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
  }
  /// From the unit direction d, linear between cells but not over the horizon. Black where there is no sky.
  Spectrum operator()(const Vec3& d) const;
};

/// Sensors, and what they measured.
struct MeasuredSensors {
  SensorSet set;
  std::vector<double> illuminance;  ///< one a point [lx]
  Field layers{};                   ///< points x lanes, irradiance by layer [W/m2]; empty: there are none
};

/// A part of the light that can be dimmed by itself; its light is in arrays of its name (layer_arrays.h).
struct ShownLayer {
  std::string name;
  EnergyBalance energy;  ///< as of the whole light [W]
  SkyTable sky{};        ///< what it has of the sky; empty: nothing
  double factor = 1;     ///< by which it was dimmed since it was solved [1]

  /// Flux that it emits; of sky and sun, what arrives on surfaces first [lm].
  double luminous_flux() const { return kWhiteEfficacy * energy.emitted; }
};

struct ShownLuminaire {
  Vec3 position;             ///< scene's frame [m]
  std::string name, group;   ///< may be empty
  double luminous_flux = 0;  ///< dimming included [lm]
};

struct SceneAround {
  std::optional<double> daylight_reference{};  ///< illuminance on open ground, that daylight factors are shares of [lx]
  std::vector<PaneTriangle> panes{};
  SkyTable sky{};
  std::vector<MeasuredSensors> sensors{};  ///< empty when there was no time for them
  std::vector<ShownLuminaire> luminaires{};
  std::vector<ShownLayer> layers{};  ///< they sum to the light; empty: it was not solved in layers
  std::vector<std::string> files{};  ///< that the scene was read from, as they were named
};

/// Illuminance of the sensors in layer number `layer` [lx], one a point.
std::vector<double> illuminance_of_layer(const SceneAround& around, const MeasuredSensors& sensors, std::size_t layer);

}  // namespace clerestory
