#include "solver/noisy_patches.h"

#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/units.h"
#include "solver/sampling.h"

namespace clerestory {

std::size_t gather_noisy_patches(const Problem& problem, Solution& solution, double fewest,
                                 const GatherQuality& quality, std::uint64_t seed, const Monitor& monitor) {
  constexpr std::uint64_t kNoisyPatches = 0x81;
  const PatchSet& patches = problem.patches;
  const Illumination light(problem, solution.B);
  std::vector<std::uint32_t> noisy;
  for (std::size_t i = 0; i < patches.patch_count(); ++i)
    if (patches.area[i] * luminous_mean(solution.E[i]) < fewest * solution.flux_per_ray)
      noisy.push_back(static_cast<std::uint32_t>(i));

  // All from the same B: which patch is gathered first must not matter.
  Field E = solution.E;
  std::vector<unsigned long long> rays(noisy.size(), 0);
  constexpr std::size_t kBlock = 2048;
  for (std::size_t begin = 0; begin < noisy.size() && !monitor.should_stop(); begin += kBlock) {
    monitor.report("noisy patches", static_cast<double>(begin) / static_cast<double>(noisy.size()));
    parallel_for(std::min(kBlock, noisy.size() - begin), 16, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = begin + from; k < begin + to; ++k) {
        const PatchId i{noisy[k]};
        const std::uint64_t key = stream_key(seed, kNoisyPatches, i);
        RandomStream random(key);
        const double u = random.uniform(), v = random.uniform();
        const Vec3 n = patches.normal[i];
        const Vec3 p = point_on_triangle(patches.corner_positions(i), u, v) + n * problem.rays.lift();
        E.set(i, gather_point(light, p, n, quality, key, rays[k]));
      }
    });
  }
  for (const std::uint32_t i : noisy) {
    solution.E.set(i, E[i]);
    solution.B.set(i, patches.M[i] + patches.rho[i] * E[i]);
  }
  for (const auto r : rays) solution.rays += r;
  return noisy.size();
}

}  // namespace clerestory
