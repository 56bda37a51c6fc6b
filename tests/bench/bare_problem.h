#pragma once
// A scene as paths want it: its faces, without a fine mesh.

#include "meshing/build_patches.h"
#include "solver/illumination/place_lights.h"
#include "solver/illumination/problem.h"
#include "solver/model/scene.h"
#include "solver/spaces/lit_sides.h"

namespace clerestory {

struct BareProblem {
  PatchSet patches;
  RayScene rays;
  Lights lights;
  Problem problem{patches, rays, lights};

  explicit BareProblem(const Scene& scene)
      : patches(faces_of(scene)), rays(patches), lights(place_lights(scene.lights, patches, rays)) {
    make_patches(patches, find_lit_sides(problem, 1).wanted);
  }
  BareProblem(const BareProblem&) = delete;

 private:
  static PatchSet faces_of(const Scene& scene) {
    PatchSet patches = build_patches(scene, {.max_element = 1e3}).patches;
    patches.channels = scene.channels();
    return patches;
  }
};

}  // namespace clerestory
