#include "solver/solve.h"

#include "solver/closure.h"
#include "solver/lights/direct.h"
#include "solver/methods/path.h"
#include "solver/methods/progressive.h"

namespace clerestory {
namespace {

int by_accuracy(Accuracy accuracy, int draft, int standard, int fine) {
  return accuracy == Accuracy::draft ? draft : accuracy == Accuracy::standard ? standard : fine;
}

}  // namespace

double target_triangles(Accuracy accuracy) { return by_accuracy(accuracy, 2000, 6000, 20'000); }

int paths_per_point(const SolveOptions& options) {
  return by_accuracy(options.accuracy, 64, 256, 1024) << options.tighten;
}

Solution solve(const Problem& problem, const SolveOptions& options, const Monitor& monitor) {
  const Illumination light(problem);
  const int more = 1 << options.tighten;
  const DirectOptions direct_options{.lamp_rays = by_accuracy(options.accuracy, 16, 16, 64),
                                     .sky_rays = by_accuracy(options.accuracy, 128, 256, 1024) * more,
                                     .seed = options.seed};
  const DirectLight direct = direct_light(light, direct_options, monitor);
  const Closure closure = measure_closure(problem, by_accuracy(options.accuracy, 32, 64, 128), options.seed);
  switch (options.method) {
    case Method::progressive: {
      const ShootOptions shoot_options{.stop_fraction = by_accuracy(options.accuracy, 10, 3, 1) * 1e-3,
                                       .rays_per_patch = by_accuracy(options.accuracy, 64, 256, 1024) * 1.0 * more,
                                       .seed = options.seed};
      return shoot(problem, direct, closure, shoot_options, monitor);
    }
    case Method::path:
      return path_trace(light, direct, closure, {paths_per_point(options), options.seed}, monitor);
    case Method::gauss_seidel:
    case Method::jacobi:
      break;
  }
  return {};
}

}  // namespace clerestory
