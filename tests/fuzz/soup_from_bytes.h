#pragma once
// A small scene decoded from bytes, for what comes after the readers. Any bytes give one; it may be as odd as scenes
// get: faces that cross, touch, cover each other, are slivers, points or bent.

#include <span>

#include "solver/model/scene.h"

namespace clerestory {

/// Bytes one after the other; 0 when there are no more.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}
  std::uint8_t next() {
    if (rest_.empty()) return 0;
    const std::uint8_t b = rest_.front();
    rest_ = rest_.subspan(1);
    return b;
  }
  std::size_t below(std::size_t n) { return next() % n; }
  bool empty() const { return rest_.empty(); }

 private:
  std::span<const std::uint8_t> rest_;
};

/// A tenth of the vertices and a few more have something to them: most lie on a grid of 16 x 16 x 16 over 4 m, so that
/// faces meet; the high half of a coordinate's byte moves it off by a little, or far away.
inline double coordinate_from(Bytes& bytes) {
  const std::uint8_t b = bytes.next();
  const double x = (b & 15) * 0.25;
  switch (b >> 4) {
    case 15:
      return x + 1e-9 * bytes.next();
    case 14:
      return x + 1e-6 * bytes.next();
    case 13:
      return x + 1e-3 * bytes.next();
    case 12:
      return -x;
    case 11:
      return x * bytes.next();
    default:
      return x;
  }
}

/// Up to 16 vertices, up to 24 faces of three to six corners, and the materials below: each of them differs in what
/// light and mesh make of it.
inline Scene soup_from(Bytes& bytes) {
  Scene scene;
  scene.file = "soup";
  const auto add = [&](const char* name, MaterialKind kind, double reflectance, double transmittance, double exitance,
                       int sides) {
    scene.materials.push_back({.name = name,
                               .kind = kind,
                               .reflectance = Spectrum(reflectance),
                               .transmittance = Spectrum(transmittance),
                               .exitance = Spectrum(exitance),
                               .total_power = {},
                               .sides = sides});
    scene.surfaces.emplace_back(name);
  };
  add("grey", MaterialKind::diffuse, 0.5, 0, 0, 2);
  add("glowing", MaterialKind::diffuse, 0.25, 0, 10, 2);
  add("one-sided", MaterialKind::diffuse, 0.75, 0, 0, 1);
  add("black", MaterialKind::diffuse, 0, 0, 0, 2);
  add("white", MaterialKind::diffuse, 0.99, 0, 0, 2);
  add("glass", MaterialKind::glass, 0, 0.875, 0, 2);
  add("diffuser", MaterialKind::diffuser, 0.375, 0.5, 0, 2);
  add("mirror", MaterialKind::mirror, 0.875, 0, 0, 2);

  PolygonSoup& soup = scene.polygons;
  const std::size_t vertices = 3 + bytes.below(14), faces = 1 + bytes.below(24);
  for (std::size_t v = 0; v < vertices; ++v) {
    const double x = coordinate_from(bytes), y = coordinate_from(bytes), z = coordinate_from(bytes);
    soup.add_vertex({x, y, z});
  }
  for (std::size_t f = 0; f < faces && !bytes.empty(); ++f) {
    const std::size_t kind = bytes.next(), corners = 3 + (kind / 64);
    const std::size_t material = kind % scene.materials.size();
    for (std::size_t k = 0; k < corners; ++k) soup.add_corner(static_cast<std::uint32_t>(bytes.below(vertices)));
    soup.end_face(MaterialId{material}, SurfaceId{material});
  }
  return scene;
}

}  // namespace clerestory
