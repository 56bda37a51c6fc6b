#include "solver/noisy_patches.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/units.h"
#include "solver/sampling.h"

namespace clerestory {
namespace {

/// Patches that fewer than `fewest` rays are expected to meet, by the irradiance of their neighbourhood (a cell of
/// space and the way they face). Their own would choose those that few rays met by chance, and lift the mean.
std::vector<std::uint32_t> noisy_patches(const Problem& problem, const Solution& solution, double fewest) {
  const PatchSet& patches = problem.patches;
  const std::size_t n = patches.patch_count();
  const double cell = 4 * std::sqrt(patches.total_area() / static_cast<double>(std::max<std::size_t>(n, 1)));
  const auto neighbourhood = [&](std::size_t i) {
    const auto c = patches.corner_positions(PatchId{i});
    const Vec3 centre = (c[0] + c[1] + c[2]) / 3, normal = patches.normal[i];
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      key = stream_key(key, static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(centre[axis] / cell))));
      key = stream_key(key, static_cast<std::uint64_t>(static_cast<std::int64_t>(std::round(normal[axis])) + 1));
    }
    return key;
  };
  struct Sum {
    double flux = 0, area = 0;
  };
  std::unordered_map<std::uint64_t, Sum> sums;
  for (std::size_t i = 0; i < n; ++i) {
    Sum& sum = sums[neighbourhood(i)];
    sum.flux += patches.area[i] * luminous_mean(solution.E[i]);
    sum.area += patches.area[i];
  }
  std::vector<std::uint32_t> noisy;
  for (std::size_t i = 0; i < n; ++i) {
    const Sum& sum = sums[neighbourhood(i)];
    if (patches.area[i] * sum.flux < fewest * solution.flux_per_ray * sum.area)
      noisy.push_back(static_cast<std::uint32_t>(i));
  }
  return noisy;
}

}  // namespace

std::size_t gather_noisy_patches(const Problem& problem, Solution& solution, double fewest,
                                 const GatherQuality& quality, std::uint64_t seed, const Monitor& monitor) {
  constexpr std::uint64_t kNoisyPatches = 0x81;
  const PatchSet& patches = problem.patches;
  const Illumination light(problem, solution.B);
  const GatherPattern pattern(quality, seed);
  const std::vector<std::uint32_t> noisy = noisy_patches(problem, solution, fewest);

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
        E.set(i, gather_point(light, p, n, pattern, rays[k]).E);
      }
    });
  }
  solution.E = std::move(E);
  const auto new_radiosity = [&](std::size_t i) { solution.B.set(i, patches.M[i] + patches.scattered(solution.E, i)); };
  for (const std::uint32_t i : noisy) {
    new_radiosity(i);
    for (const PatchSet::Behind& other : patches.patches_behind(i)) new_radiosity(other.patch);
  }
  for (const auto r : rays) solution.rays += r;
  return noisy.size();
}

}  // namespace clerestory
