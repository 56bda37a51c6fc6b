#pragma once
// Closed rooms made directly as patches, for tests of what comes after meshing.

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "solver/model/patch_set.h"

namespace clerestory::test {

/// Both sides of every triangle take part.
inline PatchSet two_sided(PatchSet patches) {
  make_patches(patches, std::vector<bool>(2 * patches.triangle_count(), true));
  return patches;
}

/// Puts rectangles of triangles together to a PatchSet of one-sided patches. Triangles share no vertices, which the
/// solver does not need.
class PatchBuilder {
 public:
  explicit PatchBuilder(double reflectance = 0.5) {
    Material material;
    material.name = "surface";
    material.reflectance = Spectrum(reflectance);
    material.sides = 1;
    set_.materials = {material};
  }

  /// A new material for what is added from now on.
  PatchBuilder& material(double reflectance, double exitance = 0) {
    Material m = set_.materials.front();
    m.reflectance = Spectrum(reflectance), m.exitance = Spectrum(exitance);
    set_.materials.push_back(m);
    material_ = MaterialId{set_.materials.size() - 1};
    return *this;
  }
  /// Glass for what is added from now on.
  PatchBuilder& glass(double transmittance) {
    Material m;
    m.kind = MaterialKind::glass, m.transmittance = Spectrum(transmittance);
    set_.materials.push_back(m);
    material_ = MaterialId{set_.materials.size() - 1};
    return *this;
  }
  /// A diffuser for what is added from now on.
  PatchBuilder& diffuser(double reflectance, double transmittance) {
    Material m;
    m.kind = MaterialKind::diffuser, m.reflectance = Spectrum(reflectance), m.transmittance = Spectrum(transmittance);
    set_.materials.push_back(m);
    material_ = MaterialId{set_.materials.size() - 1};
    return *this;
  }
  /// A mirror for what is added from now on.
  PatchBuilder& mirror(double reflectance) {
    Material m;
    m.kind = MaterialKind::mirror, m.reflectance = Spectrum(reflectance);
    set_.materials.push_back(m);
    material_ = MaterialId{set_.materials.size() - 1};
    return *this;
  }
  /// A glossy surface for what is added from now on.
  PatchBuilder& glossy(double reflectance, const Gloss& gloss, double exitance = 0) {
    Material m;
    m.kind = MaterialKind::glossy, m.reflectance = Spectrum(reflectance), m.exitance = Spectrum(exitance);
    m.gloss = gloss;
    set_.materials.push_back(m);
    material_ = MaterialId{set_.materials.size() - 1};
    return *this;
  }
  /// A new named surface for what is added from now on.
  PatchBuilder& surface(const std::string& name) {
    set_.surfaces.push_back(name);
    return *this;
  }

  PatchBuilder& triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const std::size_t first = set_.vertices.size();
    for (const Vec3& x : {a, b, c}) set_.vertices.push_back(x);
    set_.corners.push_back({VertexId{first}, VertexId{first + 1}, VertexId{first + 2}});
    set_.side_material.push_back({material_, material_});
    const SurfaceId s{set_.surfaces.empty() ? 0 : set_.surfaces.size() - 1};
    set_.side_surface.push_back({s, s});
    return *this;
  }
  /// Parallelogram with corner o and sides u, v; its front is along cross(u, v). nu x nv cells of two triangles.
  PatchBuilder& rectangle(const Vec3& o, const Vec3& u, const Vec3& v, std::size_t nu = 1, std::size_t nv = 1) {
    const auto at = [&](std::size_t i, std::size_t j) {
      return o + u * (static_cast<double>(i) / static_cast<double>(nu)) +
             v * (static_cast<double>(j) / static_cast<double>(nv));
    };
    for (std::size_t j = 0; j < nv; ++j)
      for (std::size_t i = 0; i < nu; ++i)
        triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1)).triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    return *this;
  }
  /// Box with corner o and sides u, v, w (right-handed) in cells n[0] x n[1] x n[2]; fronts inside or outside.
  PatchBuilder& box(const Vec3& o, const Vec3& u, const Vec3& v, const Vec3& w, std::array<std::size_t, 3> n,
                    bool inside) {
    const auto face = [&](const Vec3& corner, const Vec3& a, std::size_t na, const Vec3& b, std::size_t nb) {
      if (inside)
        rectangle(corner, a, b, na, nb);
      else
        rectangle(corner, b, a, nb, na);
    };
    face(o, u, n[0], v, n[1]), face(o + w, v, n[1], u, n[0]);
    face(o, v, n[1], w, n[2]), face(o + u, w, n[2], v, n[1]);
    face(o, w, n[2], u, n[0]), face(o + v, u, n[0], w, n[2]);
    return *this;
  }

  PatchSet build(int channels = 1) {
    set_.channels = channels;
    if (set_.surfaces.empty()) set_.surfaces = {"room"};
    std::vector<bool> wanted(2 * set_.triangle_count(), false);
    for (std::size_t t = 0; t < set_.triangle_count(); ++t) wanted[2 * t + kFront] = true;
    make_patches(set_, wanted);
    return set_;
  }

 private:
  PatchSet set_;
  MaterialId material_{0};
};

/// Closed room of 5.5 x 4.5 x 2.8 (times scale) with two turned blocks that hang free of all walls.
struct RoomWithBlocks {
  std::array<std::size_t, 3> room_cells{16, 12, 9};
  std::size_t block_cells = 4;
  double reflectance = 0.5, exitance = 0, scale = 1;

  PatchSet build() const {
    PatchBuilder b(reflectance);
    if (exitance > 0) b.material(reflectance, exitance);
    const auto block = [&](const Vec3& o, double length, double width, double height, double turn) {
      const Vec3 u{std::cos(turn), std::sin(turn), 0}, v{-std::sin(turn), std::cos(turn), 0};
      const std::array<std::size_t, 3> cells{block_cells, block_cells, block_cells};
      b.box(o * scale, u * (length * scale), v * (width * scale), {0, 0, height * scale}, cells, false);
    };
    b.box({0, 0, 0}, {5.5 * scale, 0, 0}, {0, 4.5 * scale, 0}, {0, 0, 2.8 * scale}, room_cells, true);
    block({1.2, 1.0, 0.1}, 1.0, 1.2, 1.9, 0.30);
    block({3.6, 2.3, 0.3}, 1.3, 0.9, 0.8, -0.35);
    return b.build();
  }
};
inline RoomWithBlocks room_of_2160_patches() { return {}; }
inline RoomWithBlocks room_of_4860_patches() { return {.room_cells = {24, 21, 11}, .block_cells = 6}; }

}  // namespace clerestory::test
