#include "solver/methods/echo_factors.h"

#include <algorithm>
#include <vector>

#include "solver/model/parallel.h"
#include "solver/model/streams.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/echoes.h"

namespace clerestory {
namespace {

constexpr std::uint32_t kPilots = 64;

struct Arrival {
  std::uint32_t patch;
  double share;  ///< of a ray
};

/// returns  whether glass is in view
bool look(const PatchSet& patches, const RayScene& rays, std::size_t i, std::uint32_t count, std::uint64_t key,
          std::vector<Arrival>& arrivals) {
  const Frame frame(patches.normal[i]);
  const auto corners = patches.corner_positions(PatchId{i});
  bool sees_glass = false;
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto u = sobol4(k, key);
    const Ray ray{rays.off_surface(point_on_triangle(corners, u[2], u[3]), frame.n),
                  cosine_direction(frame, u[0], u[1])};
    Echo echo;
    rays.first_hit(patches, ray, &echo);
    if (echo.is_none()) continue;
    sees_glass = true;
    follow_echo(rays, patches, echo, key, k, [&](const Hit& hit) {
      if (hit.patch.valid()) arrivals.push_back({hit.patch.value, luminous_mean(hit.transmittance)});
    });
  }
  return sees_glass;
}

}  // namespace

void add_echoes(FormFactorMatrix& F, const PatchSet& patches, const RayScene& rays, std::uint64_t seed,
                const Monitor& monitor) {
  if (!rays.has_echoes()) return;
  std::vector<char> sees_glass(F.n);
  parallel_for(F.n, 8, [&](std::size_t from, std::size_t to) {
    std::vector<Arrival> ignored;
    for (std::size_t i = from; i < to && !monitor.should_stop(); ++i) {
      ignored.clear();
      sees_glass[i] = look(patches, rays, i, kPilots, mix_bits(stream_key(seed, kEchoFactors, i)), ignored);
    }
  });
  F.rays += kPilots * F.n;
  constexpr std::size_t kBlock = 512;  // patches; bounds the memory
  std::vector<std::vector<Arrival>> found(kBlock);
  for (std::size_t begin = 0; begin < F.n && !monitor.should_stop(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, F.n - begin);
    parallel_for(count, 8, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) {
        found[k].clear();
        if (sees_glass[begin + k])
          look(patches, rays, begin + k, kEchoRays, stream_key(seed, kEchoFactors, begin + k), found[k]);
      }
    });
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = begin + k;
      if (sees_glass[i]) F.rays += kEchoRays;
      for (const auto& [j, share] : found[k]) {
        // The exchange is the same both ways: half by the rays of either, all by those of one where the other sends
        // none.
        const double F_ij = share / kEchoRays / (sees_glass[j] ? 2 : 1);
        F.value[i * F.n + j] += static_cast<float>(F_ij);
        F.value[j * F.n + i] += static_cast<float>(F_ij * patches.area[i] / patches.area[j]);
      }
    }
  }
}

}  // namespace clerestory
