// Any bytes as a scene or model: read, or refused with a message; never anything else.

#include <cmath>

#include "io/read_scene.h"
#include "tests/fuzz/fuzz_input.h"

namespace clerestory {
namespace {

void check(const Scene& scene) {
  const PolygonSoup& soup = scene.polygons;
  require(soup.face_count() > 0, "there is no face");
  require(soup.face_begin.size() == soup.face_count() + 1 && soup.surface.size() == soup.face_count() &&
              soup.face_begin.back() == soup.corner.size(),
          "the arrays of the faces do not fit together");
  for (const std::uint32_t c : soup.corner) require(c < soup.vertices.size(), "a corner has no vertex");
  for (const MaterialId m : soup.material) require(m < scene.materials.size(), "a face has no material");
  for (const SurfaceId s : soup.surface) require(s < scene.surfaces.size(), "a face has no surface");
  for (const Vec3& p : soup.vertices) require(is_finite(p), "a vertex is not finite");
  for (const Material& m : scene.materials) {
    require(m.reflectance.min() >= 0 && m.reflectance.max() < 1, "a reflectance is outside [0, 1)");
    require(m.transmittance.min() >= 0 && m.transmittance.max() <= 1, "a transmittance is outside [0, 1]");
    require(m.exitance.min() >= 0 && std::isfinite(m.exitance.max()), "an exitance is negative or infinite");
  }
  if (const auto& sky = scene.lights.sky) {
    require(sky->horizontal_irradiance.min() >= 0 && std::isfinite(sky->horizontal_irradiance.max()),
            "the sky's light is negative or infinite");
    require(std::abs(length(sky->sun) - 1) < 1e-9, "the sky's sun has no direction");
  }
  for (const Sun& sun : scene.lights.suns) {
    require(std::abs(length(sun.direction) - 1) < 1e-9, "a sun has no direction");
    require(sun.normal_irradiance.min() >= 0 && std::isfinite(sun.normal_irradiance.max()),
            "a sun's light is negative or infinite");
  }
}

/// What scene files of the corpus name.
void write_neighbours() {
  std::ofstream(fuzz_folder() / "room.obj") << "o floor\nusemtl floor\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
  std::ofstream weather(fuzz_folder() / "city.epw");
  weather << "LOCATION,City,-,-,made up,0,48.8,2.3,1,75\n1\n2\n3\n4\n5\n6\nDATA PERIODS,1,1,Data,Saturday,3/21,3/21\n";
  for (int hour = 1; hour <= 24; ++hour)
    weather << "2026,3,21," << hour
            << ",0,?,9,3,50,101300,0,0,300,600,700,130,999999,999999,999999,0,0,0,0,0,0,0,0,0,12,0,0\n";
  std::ofstream(fuzz_folder() / "points.csv") << "x,y,z,nx,ny,nz\n0.5,0.5,0.8,0,0,1\n";
}

}  // namespace
}  // namespace clerestory

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  static const bool ready = (write_neighbours(), true);
  static_cast<void>(ready);
  read_or_refuse([&] { check(read_scene(write_fuzz_input(data, size))); });
  return 0;
}
