// A small scene made of any bytes, solved by any method: light that is finite, not negative, and no more than there can
// be; or refused.

#include <algorithm>
#include <cmath>

#include "pipeline/solve_scene.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/soup_from_bytes.h"

namespace clerestory {
namespace {

/// An unbiased estimate of what is all but dark may be a little less than nothing (solver/gather/gather_point.cpp).
void require_light(const Field& field, const std::string& what) {
  double most = 0;
  for (const double x : field.value) {
    require(std::isfinite(x), what + " is infinite");
    most = std::max(most, x);
  }
  for (const double x : field.value) require(x >= -1e-3 * most, what + " is negative");
}

void check(const Solved& solved) {
  require(!solved.empty(), "nothing is solved");
  require_light(solved.solution.E, "an irradiance");
  require_light(solved.solution.B, "a radiosity");
  require_light(solved.lightmap.E, "an irradiance of a vertex");
  require_light(solved.sensor_E, "an irradiance of a sensor");
  const EnergyBalance& e = solved.solution.energy;
  require(std::isfinite(e.emitted) && e.emitted >= 0 && e.absorbed >= 0 && e.escaped >= 0,
          "a flux is negative or infinite");
  // Rough as drafts of few elements are, it is the light that was there.
  require(e.absorbed + e.escaped <= 2 * e.emitted, "there is more light than is emitted");
}

}  // namespace
}  // namespace clerestory

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  static const bool ready = (set_thread_count(1), true);  // coverage is told from run to run
  static_cast<void>(ready);
  Bytes bytes(data, size);
  Settings settings;
  settings.solve.accuracy = Accuracy::draft;
  settings.solve.method = static_cast<Method>(bytes.below(std::size(kMethodNames)));
  settings.max_element = 2;
  const std::size_t light = bytes.next();
  Scene scene = soup_from(bytes);
  if (light & 1) {
    Sky sky;
    sky.model = light & 2 ? SkyModel::uniform : SkyModel::cie_overcast;
    sky.horizontal_irradiance = Spectrum(50.0);
    scene.lights.sky = sky;
  }
  if (light & 4) scene.lights.suns.push_back({normalized(Vec3{0.3, -0.5, 0.8}), Spectrum(400.0)});
  if (light & 8) scene.lights.luminaires.push_back({"point", {1.1, 1.2, 1.3}, {}, PointLuminaire{Spectrum(5.0)}});
  if (light & 16)
    scene.lights.luminaires.push_back({"spot", {2, 2, 2}, {}, SpotLuminaire{{0, 0, -1}, Spectrum(5.0), 0.2, 0.6}});
  if (light & 32) scene.sensors.push_back({"desk", {{{1, 1, 0.8}, {0, 0, 1}}, {{2, 2, 2}, {0, 0, -1}}}});
  if (light & 64) scene.materials[0].reflectance = {0.5, 0.25, 0.125};
  read_or_refuse([&] { check(solve_scene(scene, settings)); });
  return 0;
}
