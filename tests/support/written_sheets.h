#pragma once
// A result whose figures are known: squares of one metre side by side, lit by what grows along them.

#include <string>

#include "solver/model/units.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// Sheet i lies at x from i to i + 1, faces up and is a surface and, two by two, a room of its own; E = lux(x, y).
template <class Lux>
WrittenResult written_sheets(std::size_t n, const Lux& lux, int channels = 1, const Vec3& origin = {}) {
  WrittenResult r;
  r.file = "sheets.vtp";
  r.materials.resize(1);
  r.materials[0].name = "paper";
  WrittenArray &E = r.of_points["irradiance"], &B = r.of_points["radiosity"];
  WrittenArray &lx = r.of_points["illuminance"], &L = r.of_points["luminance"];
  E.components = B.components = channels;
  for (std::size_t i = 0; i < n; ++i) {
    const auto first = static_cast<std::uint32_t>(r.points.size());
    for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      const double x = static_cast<double>(i) + u, y = v;
      r.points.push_back(origin + Vec3{x, y, 0});
      const auto value = static_cast<float>(lux(x, y));
      lx.value.push_back(value);
      L.value.push_back(value / 6);
      for (int k = 0; k < channels; ++k) {
        E.value.push_back(value / static_cast<float>(kWhiteEfficacy));
        B.value.push_back(value / static_cast<float>(2 * kWhiteEfficacy));
      }
    }
    for (const auto& t : {std::array<std::uint32_t, 3>{0, 1, 2}, {0, 2, 3}}) {
      r.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      r.material.push_back(0);
      r.surface.push_back(static_cast<std::uint32_t>(i));
      r.room.push_back(static_cast<std::uint32_t>(i / 2));
    }
    r.surfaces.push_back("sheet " + std::to_string(i));
    if (i % 2 == 0) r.rooms.push_back("room " + std::to_string(i / 2));
  }
  return r;
}

}  // namespace clerestory
