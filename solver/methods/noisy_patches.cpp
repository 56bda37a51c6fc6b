#include "solver/methods/noisy_patches.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "solver/gather/gather.h"
#include "solver/illumination/near_luminaires.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/sampling/unit_square.h"

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
  // Where a luminaire is near its light is known exactly, and one point would know nothing of it.
  const std::vector<bool> near = patches_near_luminaires(patches, problem.lights);
  std::vector<std::uint32_t> noisy;
  for (std::size_t i = 0; i < n; ++i) {
    if (near[i]) continue;
    const Sum& sum = sums[neighbourhood(i)];
    if (patches.area[i] * sum.flux < fewest * solution.flux_per_ray * sum.area)
      noisy.push_back(static_cast<std::uint32_t>(i));
  }
  return noisy;
}

}  // namespace

std::size_t gather_noisy_patches(const Problem& problem, Solution& solution, double fewest,
                                 const GatherQuality& quality, std::uint64_t seed, const Monitor& monitor) {
  const PatchSet& patches = problem.patches;
  const Illumination light(problem, solution.B);
  const GatherPattern pattern(quality, seed);
  const std::vector<std::uint32_t> noisy = noisy_patches(problem, solution, fewest);

  const auto point_of = [&](std::size_t k) {
    const PatchId i{noisy[k]};
    RandomStream random(stream_key(seed, kNoisyPatches, i));
    const double u = random.uniform(), v = random.uniform();
    const Vec3 n = patches.normal[i];
    return ReceivingPoint{problem.rays.off_surface(point_on_triangle(patches.corner_positions(i), u, v), n), n};
  };
  const PointIrradiance gathered = gather_at(light, noisy.size(), point_of, pattern, "noisy patches", monitor);
  for (std::size_t k = 0; k < gathered.done; ++k) solution.E.set(noisy[k], gathered.E[k]);
  const auto new_radiosity = [&](std::size_t i) { solution.B.set(i, patches.M[i] + patches.scattered(solution.E, i)); };
  for (const std::uint32_t i : noisy) {
    new_radiosity(i);
    for (const PatchSet::Behind& other : patches.patches_behind(i)) new_radiosity(other.patch);
  }
  solution.rays += gathered.rays;
  return noisy.size();
}

}  // namespace clerestory
