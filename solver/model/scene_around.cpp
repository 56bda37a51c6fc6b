#include "solver/model/scene_around.h"

namespace clerestory {

Spectrum SkyTable::operator()(const Vec3& d) const {
  if (empty()) return Spectrum(0.0);
  constexpr std::size_t kHalf = kRows / 2;
  const double elevation = std::asin(std::clamp(d.z, -1.0, 1.0)), azimuth = std::atan2(d.y, d.x);
  const double first = d.z < 0 ? 0 : kHalf, last = d.z < 0 ? kHalf - 1 : kRows - 1;
  const double y = std::clamp((elevation / std::numbers::pi + 0.5) * kRows - 0.5, first, last);
  const double around = azimuth / (2 * std::numbers::pi) * kColumns - 0.5 + kColumns;  // not below 0
  const auto row = static_cast<std::size_t>(y), column = static_cast<std::size_t>(around);
  const double v = y - static_cast<double>(row), u = around - static_cast<double>(column);
  const auto at = [&](std::size_t r, std::size_t c) {
    return radiance[std::min(r, kRows - 1) * kColumns + c % kColumns];
  };
  return (at(row, column) * (1 - u) + at(row, column + 1) * u) * (1 - v) +
         (at(row + 1, column) * (1 - u) + at(row + 1, column + 1) * u) * v;
}

std::vector<double> illuminance_of_layer(const SceneAround& around, const MeasuredSensors& sensors, std::size_t layer) {
  const std::size_t channels = static_cast<std::size_t>(sensors.layers.channels) / around.layers.size();
  std::vector<double> lux;
  for (std::size_t i = 0; i < sensors.layers.size(); ++i) {
    const double* E = &sensors.layers.value[(i * around.layers.size() + layer) * channels];
    lux.push_back(photometric(channels == 1 ? Spectrum(E[0]) : Spectrum(E[0], E[1], E[2])));
  }
  return lux;
}

}  // namespace clerestory
