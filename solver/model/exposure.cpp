#include "solver/model/exposure.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "solver/model/inner_rooms.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr double kMostBelow = 0.8, kBrightLight = 0.8;

/// Illuminance of the triangles that `counts` takes and that are lit, by area [lx]; 0 where none is.
struct Brightness {
  double middle = 0;  ///< geometric mean
  double upper = 0;   ///< kMostBelow of the area have no more
};

template <class Counts>
Brightness brightness_of(const WrittenResult& result, const Counts& counts) {
  const std::vector<float>& lux = result.of_points.at("illuminance").value;
  std::vector<std::pair<double, double>> lit;  // lux, m2
  double sum = 0, all = 0;
  for (std::size_t i = 0; i < result.triangles.size(); ++i) {
    if (!counts(i)) continue;
    const auto& [a, b, c] = result.triangles[i];
    const double mean = (double{lux[a]} + lux[b] + lux[c]) / 3;
    if (!(mean > 0)) continue;
    const Vec3 x = result.points[a];
    const double area = length(cross(result.points[b] - x, result.points[c] - x)) / 2;
    lit.emplace_back(mean, area);
    sum += area * std::log(mean), all += area;
  }
  if (!(all > 0)) return {};
  std::sort(lit.begin(), lit.end());
  double below = 0;
  std::size_t k = 0;
  while (k + 1 < lit.size() && below + lit[k].second < kMostBelow * all) below += lit[k++].second;
  return {std::exp(sum / all), lit[k].first};
}

}  // namespace

double exposure_of(const WrittenResult& result, double ev) {
  const std::vector<bool> inner = inner_rooms(result);
  const auto is_inside = [&](std::size_t i) { return !result.room.empty() && inner[result.room[i]]; };
  Brightness lux = brightness_of(result, is_inside);
  if (!(lux.middle > 0)) lux = brightness_of(result, [](std::size_t) { return true; });
  if (!(lux.middle > 0)) return 1;
  return std::exp2(ev) * kWhiteEfficacy * std::min(kMiddleLight / lux.middle, kBrightLight / lux.upper);
}

double srgb_encoded(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

std::uint8_t srgb_byte(double linear) { return static_cast<std::uint8_t>(std::lround(255 * srgb_encoded(linear))); }

}  // namespace clerestory
