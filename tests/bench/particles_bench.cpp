// Particles in the Cornell box, at the mesh of `standard`: ten million of them, and a photon map; with
// --kernels SCENE how far off vertices are by shape and radius of their kernels, against paths. Prints one CSV row a
// figure: what, value, unit, bar.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <span>
#include <string>
#include <vector>

#include "io/read_scene.h"
#include "pipeline/prepare.h"
#include "solver/gather/gather.h"
#include "solver/methods/particles.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"
#include "solver/particles/photon_map.h"
#include "solver/paths/path_tracer.h"
#include "tests/bench/row.h"
#include "tests/support/send_photons.h"

namespace clerestory {
namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct Start {
  Scene scene;
  Settings settings;
  Observer nobody;
  StageSeconds seconds;
  PreparedToSolve prepared;

  explicit Start(const std::string& name)
      : scene(read_scene(std::string(CLERESTORY_SOURCE_DIR) + "/data/scenes/" + name)),
        settings([&] {
          Settings s = settings_of(scene);
          s.solve.method = Method::particles;
          return s;
        }()),
        prepared(prepare_to_solve(scene, settings, nobody, {}, seconds).value()) {}
};

/// Vertices of the mesh against paths, over the mean [1]: by area.
double rms(const PatchSet& patches, const VertexLightmap& a, const VertexLightmap& b) {
  double squares = 0, mean = 0, area = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i)
    for (const std::uint32_t p : a.corners[i]) {
      const double x = luminous_mean(a.E[p]), y = luminous_mean(b.E[p]);
      squares += patches.area[i] * (x - y) * (x - y), mean += patches.area[i] * y, area += patches.area[i];
    }
  return std::sqrt(squares / area) / (mean / area);
}

void kernels(const std::string& scene) {
  const Start start(scene);
  const Problem problem = start.prepared.scene.problem();
  const Illumination light(problem);
  VertexLightmap reference = start.prepared.lightmap, map = reference;
  set_points(trace_paths_at(light, reference.sample_position.size(), sample_points(reference, problem.rays), 2048, 99,
                            "reference"),
             reference);
  for (const double particles : {100.0, 400.0, 1600.0})
    for (const KernelShape shape : {KernelShape::constant, KernelShape::cone, KernelShape::epanechnikov})
      for (const double radius : {0.8, 1.0, 1.25, 1.6, 2.0}) {
        trace_particles(light, {.particles = particles, .kernel = shape, .radius = radius}, &map);
        const char* names[] = {"constant", "cone", "epanechnikov"};
        row(scene + ' ' + std::to_string(static_cast<int>(particles)) + ' ' + names[static_cast<int>(shape)] + ' ' +
                std::to_string(radius).substr(0, 3),
            100 * rms(problem.patches, map, reference), "%");
      }
}

void ten_million() {
  const Start start("cornell_box.json");
  const Problem problem = start.prepared.scene.problem();
  const Illumination light(problem);
  VertexLightmap map = start.prepared.lightmap;
  const double from = seconds();
  const std::clock_t cpu = std::clock();
  const Solution s =
      trace_particles(light, {.particles = 1e7 / static_cast<double>(problem.patches.patch_count())}, &map);
  row("particles: ten million in the Cornell box", seconds() - from, "s", "10");
  row("particles: the same on one core", static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC, "s");
  row("particles: rays", static_cast<double>(s.rays) * 1e-6, "million");
  row("particles: imbalance", std::abs(s.energy.imbalance()), "1");
}

/// A map of the Cornell box's landings, and the nearest hundred of each of 10^5 other landings.
void photon_map() {
  const Start start("cornell_box.json");
  const Problem problem = start.prepared.scene.problem();
  const Illumination light(problem);
  constexpr std::array kAll{ParticleWay::straight, ParticleWay::turned, ParticleWay::scattered};
  std::vector<Landing> photons = test::send_photons(light, 700'000, kAll, 1),
                       places = test::send_photons(light, 100'000, kAll, 2);
  photons.resize(1'000'000), places.resize(100'000);
  double built = 1e9, queried = 1e9, of_cores = 1e9;
  for (int k = 0; k < 5; ++k) {  // the fastest: other programs slow it down
    double from = seconds();
    const PhotonMap map(photons);
    built = std::min(built, seconds() - from);
    from = seconds();
    const std::clock_t cpu = std::clock();
    parallel_for(places.size(), 1000, [&](std::size_t begin, std::size_t end) {
      std::vector<PhotonMap::Neighbour> found;
      for (std::size_t i = begin; i < end; ++i) {
        const auto& [x, y, z] = places[i].position;
        map.nearest({double{x}, double{y}, double{z}}, 1e9, 100, found);
      }
    });
    queried = std::min(queried, seconds() - from);
    of_cores = std::min(of_cores, static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
  }
  row("photon map: a million photons built", built, "s", "1");
  row("photon map: 10^5 queries of the nearest hundred", queried, "s", "1");
  row("photon map: the same on one core", of_cores, "s");
}

}  // namespace
}  // namespace clerestory

int main(int count, char** arguments) {
  using namespace clerestory;
  if (count > 2 && std::string(arguments[1]) == "--kernels")
    kernels(arguments[2]);
  else
    ten_million(), photon_map();
}
