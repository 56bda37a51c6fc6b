// Another program's use of the library: a closed room in which everything glows, so B = M / (1 - rho), and a room that
// daylight enters by a window and goes round in by a mirror.

#include <array>
#include <cmath>
#include <iostream>
#include <string>

#include "pipeline/solve_scene.h"
#include "solver/model/units.h"
#include "solver/model/version.h"

namespace {

using namespace clerestory;

/// Box of 4 x 3 x 2.5 m, wound so that its front is inside; but for the last face, all of one material.
Scene box(std::size_t material_of_last) {
  Scene scene;
  scene.surfaces = {"room"};
  for (int c = 0; c < 8; ++c) scene.polygons.add_vertex({c & 1 ? 4.0 : 0.0, c & 2 ? 3.0 : 0.0, c & 4 ? 2.5 : 0.0});
  std::size_t count = 0;
  for (const auto& face :
       {std::array{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}) {
    for (const int corner : face) scene.polygons.add_corner(static_cast<std::uint32_t>(corner));
    scene.polygons.end_face(MaterialId{++count == 6 ? material_of_last : 0}, SurfaceId{std::size_t{0}});
  }
  return scene;
}

bool glowing_room() {
  Scene scene = box(0);
  scene.file = "a room that glows";
  Material& wall = scene.materials.emplace_back();
  wall.reflectance = Spectrum(0.75);
  wall.exitance = Spectrum(10.0);
  wall.sides = 1;
  const Solved solved = solve_scene(scene, {.max_element = 1.0});
  double flux = 0;
  for (std::size_t i = 0; i < solved.patches.patch_count(); ++i)
    flux += solved.solution.B[i][0] * solved.patches.area[i];
  const double B = flux / solved.patches.total_area();
  std::cout << "clerestory " << kVersion << ": B = " << B << " W/m2, expected 40\n";
  return std::abs(B - 40) < 0.04;
}

/// Prints what a user should know.
class Teller : public Observer {
 public:
  void warn(const std::string& line) override { std::cout << "warning: " << line << "\n"; }
};

bool daylit_room() {
  Scene scene = box(1);
  scene.file = "a room with a window";
  scene.materials.resize(2);
  scene.materials[0].reflectance = Spectrum(0.5);
  scene.materials[1].kind = MaterialKind::glass;
  scene.materials[1].transmittance = Spectrum(0.7);
  scene.lights.sky = Sky{.model = SkyModel::uniform, .horizontal_irradiance = Spectrum(10'000 / kWhiteEfficacy)};
  scene.sensors = {{.name = "desk", .points = {{{1, 1.5, 0.8}, {0, 0, 1}}}}};
  const auto lux = [&] {
    Teller teller;
    const Solved solved = solve_scene(scene, {.solve = {.accuracy = Accuracy::draft}}, teller);
    std::cout << "  desk " << photometric(solved.sensor_E[0]) << " lx, measured error "
              << 100 * (solved.error ? solved.error->rms_relative : 1) << " %\n";
    return photometric(solved.sensor_E[0]);
  };
  const double without = lux();
  // A mirror of 0.9 in front of the back wall, seen from the window, instead of that wall's 0.5.
  Material& mirror = scene.materials.emplace_back();
  mirror.kind = MaterialKind::mirror;
  mirror.reflectance = Spectrum(0.9);
  for (const auto& [y, z] : {std::array{0.1, 0.1}, {2.9, 0.1}, {2.9, 2.4}, {0.1, 2.4}}) {
    scene.polygons.add_corner(static_cast<std::uint32_t>(scene.polygons.vertices.size()));
    scene.polygons.add_vertex({0.01, y, z});
  }
  scene.polygons.end_face(MaterialId{std::size_t{2}}, SurfaceId{std::size_t{0}});
  return without > 100 && lux() > without;
}

}  // namespace

int main() { return glowing_room() && daylit_room() ? 0 : 1; }
