#include "solver/lights/sky_shape_table.h"

#include <numbers>

#include "solver/sampling/gauss_legendre.h"

namespace clerestory {

double horizontal_integral(const SkyShape& shape, double elevation) {
  constexpr double pi = std::numbers::pi;
  static const GaussLegendre<64> gauss;
  const double sin_h = std::sin(elevation), cos_h = std::cos(elevation);
  // Rings around the sun: the brightness has a cusp there, and none along a ring or across the rings.
  const auto ring = [&](double chi) {
    const double along = std::cos(chi) * sin_h, across = std::sin(chi) * cos_h;  // cos Z = along + across cos psi
    double end = pi;
    if (across > std::abs(along))
      end = std::acos(-along / across);  // where the ring meets the horizon
    else if (along <= 0)
      return 0.0;
    double sum = 0;
    for (std::size_t k = 0; k < gauss.node.size(); ++k) {
      const double cos_Z = along + across * std::cos(end * (1 + gauss.node[k]) / 2);
      if (cos_Z > 0) sum += gauss.weight[k] * shape.gradation(cos_Z) * cos_Z;
    }
    return end * sum * std::sin(chi) * shape.indicatrix(chi, std::cos(chi));
  };
  const auto rings = [&](double from, double to) {
    double sum = 0;
    for (std::size_t k = 0; k < gauss.node.size(); ++k) {
      // Dense at both ends, where the part of the ring above the horizon changes like a root.
      const double t = (1 + gauss.node[k]) / 2;
      sum += gauss.weight[k] * 3 * t * (1 - t) * ring(from + (to - from) * t * t * (3 - 2 * t));
    }
    return (to - from) * sum;
  };
  const double touch = std::abs(elevation);
  // Rings that the horizon cuts, and whole ones around the sun or, when it has set, around the point opposite.
  return rings(touch, pi - touch) + (elevation > 0 ? rings(0, touch) : rings(pi - touch, pi));
}

SkyShapeTable::SkyShapeTable(const SkyShape& shape, const Vec3& sun) : sun_(sun) {
  const auto tabulate = [](std::size_t n, const auto& value) {
    Table table(n + 2);  // one beyond the end, which rounding may ask for
    for (std::size_t i = 0; i < table.size(); ++i) {
      table[i] = static_cast<float>(value(std::min(static_cast<double>(i) / kSteps, 1.0)));
    }
    return table;
  };
  const auto half = static_cast<std::size_t>(kSteps * std::numbers::sqrt2 / 2) + 1;
  const auto indicatrix = [&](double chi) { return shape.indicatrix(chi, std::cos(chi)); };
  gradation_ = tabulate(kSteps, [&](double root) { return shape.gradation(root * root); });
  near_ = tabulate(half, [&](double s) { return indicatrix(2 * std::asin(s)); });
  far_ = tabulate(half, [&](double s) { return indicatrix(std::numbers::pi - 2 * std::asin(s)); });
}

}  // namespace clerestory
