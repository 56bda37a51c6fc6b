#include "solver/model/bake_points.h"

#include <algorithm>
#include <cmath>

#include "solver/model/box.h"

namespace clerestory {
namespace {

Field field_of(const WrittenArray& array, std::size_t n) {
  Field field(n, array.components);
  std::copy(array.value.begin(), array.value.end(), field.value.begin());
  return field;
}

}  // namespace

std::vector<bool> glowing_materials(const WrittenResult& result) {
  constexpr double kRounding = 1e-4;  // the arrays are float
  const std::size_t n = result.points.size();
  const Field E = field_of(result.of_points.at("irradiance"), n), B = field_of(result.of_points.at("radiosity"), n);
  std::vector<bool> glows(result.materials.size(), false);
  for (std::size_t i = 0; i < result.triangles.size(); ++i) {
    const std::uint32_t m = result.material[i];
    for (const std::uint32_t p : result.triangles[i])
      for (int k = 0; k < B.channels && !glows[m]; ++k)
        glows[m] = B.at(p, k) * (1 - kRounding) > result.materials[m].reflectance[k] * E.at(p, k);
  }
  return glows;
}

Field shown_at_points(const WrittenResult& result, const std::vector<bool>& glows) {
  const std::size_t n = result.points.size();
  Field shown = field_of(result.of_points.at("irradiance"), n);
  const Field B = field_of(result.of_points.at("radiosity"), n);
  for (std::size_t i = 0; i < result.triangles.size(); ++i) {
    const std::uint32_t m = result.material[i];
    for (const std::uint32_t p : result.triangles[i]) {
      const bool is_black = B[p].is_black() && !result.materials[m].reflectance.is_black();
      if (glows[m] || is_black) shown.set(p, B[p]);
    }
  }
  return shown;
}

BakedMesh baked_points(const WrittenResult& result) {
  BakedMesh mesh;
  const std::size_t n = result.points.size();
  mesh.position = result.points;
  mesh.normal.resize(n);
  for (const auto& [a, b, c] : result.triangles) {
    const Vec3 x = result.points[a];
    const Vec3 twice_area = cross(result.points[b] - x, result.points[c] - x);
    for (const std::uint32_t p : {a, b, c}) mesh.normal[p] += twice_area;
  }
  for (Vec3& normal : mesh.normal) {
    normal = normalized(normal);
    if (!(length(normal) > 0)) normal = {0, 0, 1};  // of no area
  }
  mesh.E = field_of(result.of_points.at("irradiance"), n);
  mesh.illuminance = result.of_points.at("illuminance").value;
  mesh.shown = shown_at_points(result, glowing_materials(result));
  mesh.triangles = result.triangles;
  mesh.surface = result.surface;
  mesh.material = result.material;
  return mesh;
}

Vec3 near_origin(const std::vector<Vec3>& positions) {
  const Box box = Box::around(positions);
  if (positions.empty()) return {};
  double farthest = 0;
  for (int k = 0; k < 3; ++k) farthest = std::max({farthest, std::abs(box.lower[k]), std::abs(box.upper[k])});
  if (farthest <= kFarFromOrigin) return {};
  const Vec3 middle = box.centre();
  return {std::round(middle.x), std::round(middle.y), std::round(middle.z)};
}

}  // namespace clerestory
