#include "solver/annual/sun_nodes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "solver/model/solar_position.h"

namespace clerestory {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kMostDeclination = 24;  ///< of the sun, with what refraction and parallax make of it [degrees]
constexpr double kLowestNode = 1;        ///< [degrees]

struct Equatorial {
  double declination_deg, hour_angle_deg;  ///< hour angle: 0 at noon, positive in the afternoon
};

Equatorial equatorial(const Vec3& sun, double latitude_deg, double north_deg) {
  const Horizontal h = compass_direction(sun, north_deg);
  const double e = h.elevation_deg * kDegree, a = h.azimuth_deg * kDegree, phi = latitude_deg * kDegree;
  const double declination =
      std::asin(std::clamp(std::sin(phi) * std::sin(e) + std::cos(phi) * std::cos(e) * std::cos(a), -1.0, 1.0));
  const double hour_angle =
      std::atan2(-std::sin(a) * std::cos(e), std::cos(phi) * std::sin(e) - std::sin(phi) * std::cos(e) * std::cos(a));
  return {declination / kDegree, hour_angle / kDegree};
}

Vec3 direction_of(const Equatorial& place, double latitude_deg, double north_deg) {
  const double d = place.declination_deg * kDegree, t = place.hour_angle_deg * kDegree, phi = latitude_deg * kDegree;
  const double sin_e = std::sin(phi) * std::sin(d) + std::cos(phi) * std::cos(d) * std::cos(t);
  const double azimuth =
      std::atan2(-std::cos(d) * std::sin(t), std::cos(phi) * std::sin(d) - std::sin(phi) * std::cos(d) * std::cos(t));
  const double elevation = std::asin(std::clamp(sin_e, -1.0, 1.0)) / kDegree;
  return scene_direction({std::max(elevation, kLowestNode), azimuth / kDegree}, north_deg);
}

}  // namespace

SunNodes place_sun_nodes(std::span<const Vec3> suns, double latitude_deg, double north_deg, double step_deg) {
  const auto rows = static_cast<long>(std::ceil(2 * kMostDeclination / step_deg));
  const auto columns = static_cast<long>(std::ceil(360 / step_deg));
  const double height = 2 * kMostDeclination / static_cast<double>(rows), width = 360.0 / static_cast<double>(columns);
  SunNodes nodes;
  std::map<std::pair<long, long>, std::size_t> number;
  const auto node = [&](long row, long column) {
    const auto [at, is_new] = number.try_emplace({row, column % columns}, nodes.direction.size());
    if (is_new)
      nodes.direction.push_back(direction_of(
          {static_cast<double>(row) * height - kMostDeclination, static_cast<double>(column % columns) * width - 180},
          latitude_deg, north_deg));
    return at->second;
  };
  for (const Vec3& sun : suns) {
    const Equatorial at = equatorial(sun, latitude_deg, north_deg);
    const double y = std::clamp((at.declination_deg + kMostDeclination) / height, 0.0, static_cast<double>(rows));
    const double x = (at.hour_angle_deg + 180) / width;
    const long row = std::min(static_cast<long>(y), rows - 1), column = static_cast<long>(x);
    const double up = y - static_cast<double>(row), along = x - static_cast<double>(column);
    AmongNodes& among = nodes.of_sun.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      const double weight = (k & 1 ? along : 1 - along) * (k & 2 ? up : 1 - up);
      if (!(weight > 0)) continue;  // nobody may need that node
      among.node[k] = node(row + (k & 2 ? 1 : 0), column + (k & 1 ? 1 : 0));
      among.weight[k] = static_cast<float>(weight);
    }
  }
  return nodes;
}

}  // namespace clerestory
