#include "solver/solve.h"

#include <stdexcept>

#include "solver/closure.h"
#include "solver/form_factors/form_factor_matrix.h"
#include "solver/lights/direct.h"
#include "solver/memory_estimate.h"
#include "solver/methods/gauss_seidel.h"
#include "solver/methods/jacobi.h"
#include "solver/methods/path.h"
#include "solver/methods/progressive.h"
#include "solver/model/error.h"
#include "solver/model/units.h"
#include "solver/noisy_patches.h"

namespace clerestory {
namespace {

int by_accuracy(Accuracy accuracy, int draft, int standard, int fine) {
  return accuracy == Accuracy::draft ? draft : accuracy == Accuracy::standard ? standard : fine;
}

/// The gathers know light as it arrives; a luminaire's flux that misses the patches belongs to the balance too.
void count_luminaires(EnergyBalance& energy, const PatchSet& patches, const DirectLight& direct) {
  double arrived = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) arrived += patches.area[i] * luminous_mean(direct.E[i]);
  energy.emitted += direct.energy.emitted - arrived;
  energy.escaped += direct.energy.escaped;
  energy.absorbed += direct.energy.absorbed;
}

constexpr double kFewestRays = 64;  ///< a patch met by fewer is known to worse than 12 %

}  // namespace

double target_triangles(Method method, Accuracy accuracy) {
  return method == Method::hierarchical ? by_accuracy(accuracy, 1400, 2800, 5000)
                                        : by_accuracy(accuracy, 2000, 6000, 20'000);
}

int paths_per_point(const SolveOptions& options) {
  return by_accuracy(options.accuracy, 64, 256, 1024) << options.tighten;
}

Solution solve(const Problem& problem, const SolveOptions& options, const Monitor& monitor) {
  FormFactorOptions matrix_options{.seed = options.seed};
  if (options.memory_limit > 0) {
    const std::size_t sides = problem.patches.patch_count();
    const std::size_t rest = predicted_memory(
        {.triangles = problem.patches.triangle_count(), .sides = sides, .elements = sides, .points = sides});
    matrix_options.memory_limit = options.memory_limit > rest ? options.memory_limit - rest : 1;
  }
  // Before anything is computed: a matrix that does not fit is no news to wait for.
  if (options.method == Method::gauss_seidel || options.method == Method::jacobi) {
    require_matrix_fits(problem.patches.patch_count(), matrix_options);
    if (problem.rays.has_mirrors()) {
      throw InputError(
          "the scene has mirrors, which form factors do not see; use --method hierarchical, progressive or path");
    }
  }
  const Illumination light(problem);
  const int more = 1 << options.tighten;
  const DirectOptions direct_options{.lamp_rays = by_accuracy(options.accuracy, 16, 16, 64),
                                     .edge_rays = by_accuracy(options.accuracy, 64, 256, 1024) * more,
                                     .sky_rays = by_accuracy(options.accuracy, 128, 256, 1024) * more,
                                     .seed = options.seed};
  const DirectLight direct = direct_light(light, direct_options, monitor);
  const auto closure = [&] {
    monitor.report("closure", 0);
    const int rays = monitor.should_stop() ? 16 : by_accuracy(options.accuracy, 32, 64, 128);
    return measure_closure(problem, rays, options.seed);
  };
  switch (options.method) {
    case Method::hierarchical:
      break;
    case Method::progressive: {
      const ShootOptions shoot_options{.stop_fraction = by_accuracy(options.accuracy, 10, 3, 1) * 1e-3,
                                       .rays_per_patch = by_accuracy(options.accuracy, 64, 256, 1024) * 1.0 * more,
                                       .seed = options.seed};
      Solution solution = shoot(problem, direct, closure(), shoot_options, monitor);
      const GatherQuality quality{.bundle = {16, 256, by_accuracy(options.accuracy, 256, 512, 1024)},
                                  .area = {1, 3, 0.01, 512},
                                  .lamp_rays = 64};
      const std::size_t gathered = gather_noisy_patches(problem, solution, kFewestRays, quality, options.seed, monitor);
      solution.log.push_back(std::to_string(gathered) + " patches met by few rays, gathered");
      return solution;
    }
    case Method::path:
      return path_trace(light, direct, closure(), {paths_per_point(options), options.seed}, monitor);
    case Method::gauss_seidel:
    case Method::jacobi: {
      const FormFactorMatrix F = form_factor_matrix(problem.patches, problem.rays, matrix_options, monitor);
      const auto gather = options.method == Method::jacobi ? jacobi : gauss_seidel;
      Solution solution = gather(problem.patches, F, direct.E, {}, monitor);
      count_luminaires(solution.energy, problem.patches, direct);
      solution.rays += direct.rays + F.rays;
      return solution;
    }
  }
  throw std::logic_error("solve() has no such method");
}

}  // namespace clerestory
