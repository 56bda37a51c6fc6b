#include "solver/methods/path.h"

#include <algorithm>
#include <chrono>

#include "solver/model/parallel.h"
#include "solver/model/streams.h"
#include "solver/sampling/unit_square.h"
#include "solver/spaces/energy.h"

namespace clerestory {

Solution path_trace(const Problem& problem, const PathEstimator& estimator, std::string_view name,
                    const DirectLight& direct, const Closure& closure, const PathOptions& options,
                    const Monitor& monitor) {
  const PatchSet& patches = problem.patches;
  const std::size_t n = patches.patch_count();
  std::vector<PathSum> sums(n);
  std::vector<unsigned long long> rays(n, 0);

  Solution solution;
  solution.method = name;
  constexpr int kRound = 16;
  int done = 0;
  constexpr std::size_t kBlock = 1 << 12;
  Monitor patient = monitor;  // the first round gets a little more time: every patch needs a value
  if (monitor.has_deadline()) patient.deadline += std::chrono::seconds(1);
  for (; done < options.paths && solution.stop == StopReason::converged; done += kRound) {
    const Monitor& asked = done == 0 ? patient : monitor;
    for (std::size_t begin = 0; begin < n; begin += kBlock) {
      monitor.report("paths", (done + kRound * static_cast<double>(begin) / static_cast<double>(n)) / options.paths);
      parallel_for(std::min(kBlock, n - begin), 16, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = begin + from; i < begin + to; ++i) {
          const auto corners = patches.corner_positions(PatchId{i});
          const Vec3 normal = patches.normal[i];
          const std::uint64_t key = stream_key(options.seed, kPathsOfPatch, i);
          for (int k = done; k < std::min(done + kRound, options.paths); ++k) {
            const auto u = sobol4(static_cast<std::uint32_t>(k), key);
            RandomStream random(key, static_cast<std::uint64_t>(k), 1);
            const Vec3 start = problem.rays.off_surface(point_on_triangle(corners, u[2], u[3]), normal);
            const PathStart first = path_start({u[0], u[1]}, static_cast<std::uint32_t>(k), key);
            const Spectrum E = estimator(start, normal, first, random, rays[i], asked);
            if (asked.should_stop()) return;
            sums[i].add(E);
          }
        }
      });
      if (asked.should_stop()) {
        solution.stop = why_stopped(monitor);
        break;
      }
    }
  }

  solution.E = solution.B = solution.std_error = Field(n, patches.channels);
  solution.energy = direct.energy;
  solution.energy.emitted += total_flux(patches, patches.M);
  solution.rays = direct.rays + closure.rays;
  for (std::size_t i = 0; i < n; ++i) {
    if (sums[i].count == 0) {
      solution.E.set(i, direct.E[i]);
      continue;
    }
    solution.E.set(i, options.caustics ? sums[i].mean() + (*options.caustics)[i] : sums[i].mean());
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Spectrum B = patches.M[i] + patches.scattered(solution.E, i);
    solution.B.set(i, B);
    solution.std_error.set(i, sums[i].std_error());
    solution.energy += where_light_ends(patches, i, solution.E[i], B, losses(closure, i));
    solution.iterations += static_cast<long>(sums[i].count);
    solution.rays += rays[i];
  }
  return solution;
}

}  // namespace clerestory
