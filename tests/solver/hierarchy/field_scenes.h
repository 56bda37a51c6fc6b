#pragma once
// Meshed scenes for tests of elements and the field on them.

#include <algorithm>
#include <array>
#include <cmath>

#include "meshing/make_lightmap.h"
#include "solver/hierarchy/element_mesh.h"
#include "solver/illumination/place_lights.h"
#include "solver/spaces/lit_sides.h"
#include "solver/visibility/ray_scene.h"
#include "tests/meshing/mesh_checks.h"

namespace clerestory::testing {

/// A closed room of 4 x 3 x 2.5 with a box on the floor and a lamp under the ceiling; the room's outside is dark.
inline SceneMaker room_with_box() {
  SceneMaker maker;
  maker.box({0, 0, 0}, {4, 3, 2.5});
  maker.box({1, 1, 0}, {1.6, 1.7, 0.8});
  const MaterialId lamp = maker.material("lamp", 0.2);
  maker.edit(lamp).exitance = Spectrum(50);
  maker.edit(lamp).sides = 1;
  maker.polygon({{2, 1, 2.4}, {2, 1.5, 2.4}, {2.5, 1.5, 2.4}, {2.5, 1, 2.4}}, lamp);
  return maker;
}

/// [rad]
inline double smallest_angle(const std::array<Vec3, 3>& x) {
  double smallest = 4;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 e = x[(k + 1) % 3] - x[k], f = x[(k + 2) % 3] - x[k];
    smallest = std::min(smallest, std::atan2(length(cross(e, f)), dot(e, f)));
  }
  return smallest;
}

/// Everything a solve starts from.
struct MeshedRoom {
  PatchSet patches;
  RayScene rays;
  Lights lights;
  VertexLightmap map;

  MeshedRoom(SceneMaker maker, double max_element)
      : patches(build_patches(maker.scene(), {.max_element = max_element}).patches),
        rays(patches),
        lights(to_local_frame(maker.scene().lights, patches.origin)) {
    make_patches(patches, find_lit_sides({patches, rays, lights}).wanted);
    map = make_lightmap(patches);
  }
  Problem problem() const { return {patches, rays, lights}; }
};

}  // namespace clerestory::testing
