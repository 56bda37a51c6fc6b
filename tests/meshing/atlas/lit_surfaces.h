#pragma once
// Results put together by hand: grids of triangles with known light.

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "solver/model/units.h"
#include "solver/model/written_result.h"
#include "tests/support/flat_result.h"

namespace clerestory {

class LitSurfaces {
 public:
  using Light = std::function<double(const Vec3&)>;  ///< [lx]

  LitSurfaces() : result(empty_result()) { result.surfaces.clear(); }

  std::uint32_t add_point(const Vec3& p, double lux) {
    result.points.push_back(p);
    const double E = lux / kWhiteEfficacy;
    result.of_points["illuminance"].value.push_back(static_cast<float>(lux));
    result.of_points["irradiance"].value.push_back(static_cast<float>(E));
    result.of_points["radiosity"].value.push_back(static_cast<float>(result.materials[0].reflectance[0] * E));
    return static_cast<std::uint32_t>(result.points.size() - 1);
  }
  std::uint32_t add_surface(const std::string& name) {
    result.surfaces.push_back(name);
    return static_cast<std::uint32_t>(result.surfaces.size() - 1);
  }
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    result.triangles.push_back({a, b, c});
    result.material.push_back(0);
    result.surface.push_back(static_cast<std::uint32_t>(result.surfaces.size() - 1));
  }

  /// columns x rows squares, each of two triangles, of a surface that place(s, t) bends, s and t in [0, 1], where
  /// keep(column, row) says so; points of neighbours are shared.
  void add_grid(
      const std::function<Vec3(double, double)>& place, int columns, int rows, const Light& lux,
      const std::function<bool(int, int)>& keep = [](int, int) { return true; }) {
    const auto first = static_cast<std::uint32_t>(result.points.size());
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i) {
        const Vec3 p = place(static_cast<double>(i) / columns, static_cast<double>(j) / rows);
        add_point(p, lux(p));
      }
    const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (columns + 1) + i); };
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        if (!keep(i, j)) continue;
        add_triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
        add_triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
      }
  }

  WrittenResult result;
};

/// A rectangle from `corner` along two sides.
inline std::function<Vec3(double, double)> rectangle(const Vec3& corner, const Vec3& a, const Vec3& b) {
  return [=](double s, double t) { return corner + a * s + b * t; };
}

}  // namespace clerestory
