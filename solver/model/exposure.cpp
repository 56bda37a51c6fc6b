#include "solver/model/exposure.h"

#include <algorithm>
#include <cmath>

#include "solver/model/inner_rooms.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

/// exp(mean of log of the illuminance), by area, of triangles that are lit; 0 where none is [lx].
template <class Counts>
double middle_of(const WrittenResult& result, const Counts& counts) {
  const std::vector<float>& lux = result.of_points.at("illuminance").value;
  double sum = 0, all = 0;
  for (std::size_t i = 0; i < result.triangles.size(); ++i) {
    if (!counts(i)) continue;
    const auto& [a, b, c] = result.triangles[i];
    const double mean = (double{lux[a]} + lux[b] + lux[c]) / 3;
    if (!(mean > 0)) continue;
    const Vec3 x = result.points[a];
    const double area = length(cross(result.points[b] - x, result.points[c] - x)) / 2;
    sum += area * std::log(mean), all += area;
  }
  return all > 0 ? std::exp(sum / all) : 0;
}

}  // namespace

double exposure_of(const WrittenResult& result, double ev) {
  const std::vector<bool> inner = inner_rooms(result);
  const auto is_inside = [&](std::size_t i) { return !result.room.empty() && inner[result.room[i]]; };
  double lux = middle_of(result, is_inside);
  if (!(lux > 0)) lux = middle_of(result, [](std::size_t) { return true; });
  return lux > 0 ? std::exp2(ev) * kMiddleLight * kWhiteEfficacy / lux : 1;
}

double srgb_encoded(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

std::uint8_t srgb_byte(double linear) { return static_cast<std::uint8_t>(std::lround(255 * srgb_encoded(linear))); }

}  // namespace clerestory
