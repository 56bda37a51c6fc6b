#include "solver/spaces/closure.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "solver/model/disjoint_sets.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/openings/openings.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/echoes.h"

namespace clerestory {

Closure measure_closure(const Problem& problem, int rays_per_patch, std::uint64_t seed, const Monitor& monitor) {
  const PatchSet& patches = problem.patches;
  const RayScene& rays = problem.rays;
  const std::vector<LightArea> slits = slits_among(problem.lights.openings);
  const std::size_t n = patches.patch_count();
  Closure closure;
  closure.arrives = closure.escapes = Field(n, patches.channels);
  closure.has_gloss = rays.has_gloss();
  closure.rays = n * static_cast<std::size_t>(rays_per_patch);
  // The first few neighbours of each patch are enough to tell spaces apart.
  constexpr int kNeighbours = 16;
  std::vector<std::array<PatchId, kNeighbours>> neighbours(n);
  std::atomic<bool> stopped = false;
  parallel_for(n, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (stopped || (i % 16 == 0 && monitor.should_stop())) {
        stopped = true;
        return;
      }
      const Frame frame(patches.normal[i]);
      const auto corners = patches.corner_positions(PatchId{i});
      Spectrum arrives(0.0), escapes(0.0);
      for (int k = 0; k < rays_per_patch; ++k) {
        const auto u = sobol4(static_cast<std::uint32_t>(k), stream_key(seed, kClosureRays, i));
        const Ray ray{rays.off_surface(point_on_triangle(corners, u[2], u[3]), frame.n),
                      cosine_direction(frame, u[0], u[1])};
        Echo echo;
        const Hit hit = rays.first_hit(patches, ray, &echo);
        const auto take = [&](const Hit& h) {
          if (h.escaped()) escapes += h.transmittance;
          if (h.patch.valid()) arrives += h.transmittance;
        };
        take(hit);
        follow_echo(rays, patches, echo, stream_key(seed, kClosureRays, i), static_cast<std::uint64_t>(k), take);
        if (k >= kNeighbours || !hit.patch.valid()) continue;
        if (std::ranges::none_of(
                slits, [&](const LightArea& slit) { return is_passed(slit, ray.origin, ray.direction, hit.first); }))
          neighbours[i][static_cast<std::size_t>(k)] = hit.patch;
      }
      closure.arrives.set(i, arrives / rays_per_patch);
      closure.escapes.set(i, escapes / rays_per_patch);
    }
  });

  closure.complete = !stopped;
  DisjointSets spaces(n);
  for (std::size_t i = 0; i < n; ++i)
    for (const PatchId q : neighbours[i])
      if (q.valid()) spaces.join(i, q);
  for (std::size_t i = 0; i < n; ++i)
    for (const PatchSet::Behind& other : patches.patches_behind(i)) spaces.join(i, other.patch);
  closure.space.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t root = spaces.find(i);
    closure.space[i] = root == i ? static_cast<std::uint32_t>(closure.spaces++) : closure.space[root];
  }
  return closure;
}

}  // namespace clerestory
