#pragma once
// Results put together by hand, for pictures of known light.

#include <initializer_list>
#include <numbers>

#include "solver/model/written_result.h"

namespace clerestory {

/// A result of one channel without a triangle; material 0 is a wall.
inline WrittenResult empty_result() {
  WrittenResult r;
  r.file = "small.vtp";
  r.materials.resize(1);
  r.surfaces = {"all"};
  for (const char* name : {"irradiance", "illuminance", "radiosity", "luminance"}) r.of_points[name].components = 1;
  return r;
}

/// Adds a quad, corners counter-clockwise from the lit side, of radiosity pi L and of `lux` [lx] at each corner.
inline void add_quad(WrittenResult& r, const std::array<Vec3, 4>& corners, float L, const std::array<float, 4>& lux) {
  const auto first = static_cast<std::uint32_t>(r.points.size());
  for (std::size_t k = 0; k < 4; ++k) {
    r.points.push_back(corners[k]);
    r.of_points["radiosity"].value.push_back(static_cast<float>(std::numbers::pi) * L);
    r.of_points["illuminance"].value.push_back(lux[k]);
    r.of_points["irradiance"].value.push_back(lux[k] / 179);
    r.of_points["luminance"].value.push_back(179 * L);
  }
  r.triangles.push_back({first, first + 1, first + 2}), r.triangles.push_back({first, first + 2, first + 3});
  r.material.insert(r.material.end(), 2, 0), r.surface.insert(r.surface.end(), 2, 0);
}
inline void add_quad(WrittenResult& r, const std::array<Vec3, 4>& corners, float L, float lux) {
  add_quad(r, corners, L, {lux, lux, lux, lux});
}

inline void add_pane(WrittenResult& r, const std::array<Vec3, 4>& c, const Material& material) {
  const auto number = static_cast<std::uint32_t>(r.materials.size());
  r.materials.push_back(material);
  r.around.panes.push_back({{c[0], c[1], c[2]}, number, 0});
  r.around.panes.push_back({{c[0], c[2], c[3]}, number, 0});
}

/// A square of 2 x 2 m across the y axis, seen from smaller y.
inline std::array<Vec3, 4> square_at(double y, double half = 1) {
  return {Vec3{-half, y, -half}, {half, y, -half}, {half, y, half}, {-half, y, half}};
}
/// The same from the other side.
inline std::array<Vec3, 4> turned(const std::array<Vec3, 4>& q) { return {q[3], q[2], q[1], q[0]}; }

/// A room 4 x 4 x 4 m around the origin, its six walls seen from inside, all of radiance L.
inline void add_room(WrittenResult& r, float L, float lux) {
  constexpr double a = 2;
  add_quad(r, {Vec3{-a, -a, -a}, {a, -a, -a}, {a, a, -a}, {-a, a, -a}}, L, lux);
  add_quad(r, {Vec3{-a, -a, a}, {-a, a, a}, {a, a, a}, {a, -a, a}}, L, lux);
  add_quad(r, {Vec3{-a, -a, -a}, {-a, -a, a}, {a, -a, a}, {a, -a, -a}}, L, lux);
  add_quad(r, {Vec3{-a, a, -a}, {a, a, -a}, {a, a, a}, {-a, a, a}}, L, lux);
  add_quad(r, {Vec3{-a, -a, -a}, {-a, a, -a}, {-a, a, a}, {-a, -a, a}}, L, lux);
  add_quad(r, {Vec3{a, -a, -a}, {a, -a, a}, {a, a, a}, {a, a, -a}}, L, lux);
}

}  // namespace clerestory
