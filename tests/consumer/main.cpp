// The whole data flow from another program: a closed room in which everything glows, so B = M / (1 - rho).

#include <cmath>
#include <iostream>

#include "meshing/build_patches.h"
#include "meshing/make_lightmap.h"
#include "solver/lit_sides.h"
#include "solver/model/version.h"
#include "solver/solve_hierarchical.h"

int main() {
  using namespace clerestory;
  Scene scene;
  scene.file = "a room made by the program";
  Material& wall = scene.materials.emplace_back();
  wall.reflectance = Spectrum(0.75);
  wall.exitance = Spectrum(10.0);
  wall.sides = 1;
  scene.surfaces = {"room"};
  for (int c = 0; c < 8; ++c) scene.polygons.add_vertex({c & 1 ? 4.0 : 0.0, c & 2 ? 3.0 : 0.0, c & 4 ? 2.5 : 0.0});
  for (const auto& face :
       {std::array{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}) {
    for (const int corner : face) scene.polygons.add_corner(static_cast<std::uint32_t>(corner));
    scene.polygons.end_face(MaterialId{std::size_t{0}}, SurfaceId{std::size_t{0}});
  }

  auto [patches, report] = build_patches(scene, {.max_element = 1.0});
  const RayScene rays(patches);
  const Lights lights = to_local_frame(scene.lights, patches.origin);
  const Problem problem{patches, rays, lights};
  make_patches(patches, find_lit_sides(problem).wanted);
  const ShownSolution shown = solve_hierarchical(problem, make_lightmap(patches), report.max_element, {});

  double flux = 0;
  for (std::size_t i = 0; i < shown.elements.patch_count(); ++i)
    flux += shown.solution.B[i][0] * shown.elements.area[i];
  const double B = flux / shown.elements.total_area();
  std::cout << "clerestory " << kVersion << ": B = " << B << " W/m2, expected 40\n";
  return std::abs(B - 40) < 0.04 ? 0 : 1;
}
