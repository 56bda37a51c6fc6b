#pragma once
// Results whose light is known, without a file.

#include <functional>

#include "solver/model/written_result.h"

namespace clerestory {

/// A result to fill.
inline WrittenResult empty_result(int channels = 1) {
  WrittenResult r;
  r.file = "a.vtp";
  for (const char* name : {"irradiance", "radiosity"}) r.of_points[name].components = channels;
  r.of_points["illuminance"], r.of_points["luminance"];
  r.materials.resize(1);
  r.materials[0].name = "paint";
  r.surfaces = {"floor"};
  return r;
}

/// A rectangle from `corner` along u and v, counter-clockwise from the lit side, in n x n squares of two triangles;
/// E [W/m2] at each point.
inline void add_rectangle(WrittenResult& r, const Vec3& corner, const Vec3& u, const Vec3& v, std::uint32_t n,
                          const std::function<double(const Vec3&)>& E, std::uint32_t surface = 0,
                          std::uint32_t material = 0) {
  const auto first = static_cast<std::uint32_t>(r.points.size());
  const int channels = r.of_points["irradiance"].components;
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x) {
      const Vec3 p = corner + u * (double{1} * x / n) + v * (double{1} * y / n);
      r.points.push_back(p);
      const double grey = E(p);
      for (int k = 0; k < channels; ++k) {
        const auto e = static_cast<float>(grey * (1 + 0.25 * k));
        r.of_points["irradiance"].value.push_back(e);
        r.of_points["radiosity"].value.push_back(e * static_cast<float>(r.materials[material].reflectance[k]));
      }
      r.of_points["illuminance"].value.push_back(static_cast<float>(179 * grey));
      r.of_points["luminance"].value.push_back(0);
    }
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = first + y * (n + 1) + x, b = a + n + 1;
      r.triangles.push_back({a, a + 1, b + 1});
      r.triangles.push_back({a, b + 1, b});
      r.surface.insert(r.surface.end(), 2, surface);
      r.material.insert(r.material.end(), 2, material);
    }
}

}  // namespace clerestory
