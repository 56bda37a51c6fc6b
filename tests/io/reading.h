#pragma once
// What tests of reading share: files written on the spot, and the message of a refusal.

#include <algorithm>
#include <string>
#include <string_view>

#include "io/read_scene.h"
#include "solver/model/error.h"
#include "tests/support/temp_folder.h"

namespace clerestory {

/// A square of one metre at z = 0 and a wall, as users draw them.
inline constexpr std::string_view kRoomObj =
    "o floor\nusemtl wood\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"
    "o north wall\nusemtl wall paint\nv 0 1 2\nv 1 1 2\nf 4 3 6 5\n";

/// The message with which `file` is refused; what else happens fails the test that compares it.
inline std::string refusal(const std::string& file, const ReadOptions& options = {}) {
  try {
    read_scene(file, options);
    return "(it was read)";
  } catch (const InputError& error) {
    return error.what();
  }
}

struct Extent {
  Vec3 lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
  Vec3 size() const { return upper - lower; }
};

inline Extent extent(const Scene& scene) {
  Extent e;
  for (const Vec3& p : scene.polygons.vertices) {
    e.lower = {std::min(e.lower.x, p.x), std::min(e.lower.y, p.y), std::min(e.lower.z, p.z)};
    e.upper = {std::max(e.upper.x, p.x), std::max(e.upper.y, p.y), std::max(e.upper.z, p.z)};
  }
  return e;
}

/// Newell's normal of face f times twice its area.
inline Vec3 area_vector(const Scene& scene, std::size_t f) {
  const PolygonSoup& soup = scene.polygons;
  Vec3 sum;
  const std::uint32_t begin = soup.face_begin[f], end = soup.face_begin[f + 1];
  for (std::uint32_t c = begin; c < end; ++c) {
    const Vec3 origin = soup.vertices[soup.corner[begin]];
    sum +=
        cross(soup.vertices[soup.corner[c]] - origin, soup.vertices[soup.corner[c + 1 < end ? c + 1 : begin]] - origin);
  }
  return sum;
}

inline const Material& material(const Scene& scene, std::string_view name) {
  const auto found =
      std::find_if(scene.materials.begin(), scene.materials.end(), [&](const Material& m) { return m.name == name; });
  if (found == scene.materials.end()) throw std::runtime_error("no material " + std::string(name));
  return *found;
}

inline std::string all_warnings(const Scene& scene) {
  std::string all;
  for (const std::string& warning : scene.warnings) all += warning + "\n";
  return all;
}

}  // namespace clerestory
