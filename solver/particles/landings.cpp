#include "solver/particles/landings.h"

#include <algorithm>

#include "solver/model/units.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/echoes.h"

namespace clerestory {
namespace {

constexpr unsigned kBouncesBetween = 1 << 12;  // looks at the monitor: some milliseconds

}  // namespace

ParticleWays follow_particles(const Illumination& light, const Emission& emission, std::uint64_t key,
                              std::uint32_t first, std::uint32_t count, const Monitor& monitor) {
  const PatchSet& patches = light.problem.patches;
  const RayScene& rays = light.problem.rays;
  ParticleWays ways;
  if (emission.empty()) return ways;
  ways.landings.reserve(3 * std::size_t{count});
  for (std::uint32_t k = first; k < first + count; ++k) {
    const Emitted start = emission.sample(sobol4(k, key + 1)[0], sobol4(k, key + 2));
    if (start.flux.is_black()) continue;
    const bool from_outside =
        !start.patch.valid() && (start.is_sky() || start.light >= light.problem.lights.luminaires.size());
    if (!from_outside) ways.energy.emitted += luminous_mean(start.flux);
    RandomStream random(key, k);
    Ray ray = start.ray;
    Spectrum flux = start.flux;
    for (unsigned bounce = 0;; ++bounce) {
      if (bounce % kBouncesBetween == kBouncesBetween - 1 && monitor.should_stop()) return ways;
      const Hit hit = one_way(rays, patches, ray, random);
      ++ways.rays;
      const Spectrum arrives = flux * hit.transmittance;
      const double before = luminous_mean(flux), lands = luminous_mean(arrives);
      // Of sun and sky counts what arrives on anything.
      if (from_outside && bounce == 0) ways.energy.emitted += hit.escaped() ? before - lands : before;
      ways.energy.absorbed += before - lands;
      if (hit.escaped()) {
        if (!from_outside || bounce > 0) ways.energy.escaped += lands;
        break;
      }
      if (!hit.patch.valid() || !(lands > 0)) {
        ways.energy.absorbed += lands;
        break;
      }
      const Vec3 x = in_plane_of(patches, hit.patch, hit.position(ray));
      ways.landings.push_back(
          {{static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)},
           {static_cast<float>(arrives[0]), static_cast<float>(arrives[1]), static_cast<float>(arrives[2])},
           hit.patch.value});
      ways.energy.absorbed += luminous_mean(arrives * (Spectrum(1.0) - patches.albedo(hit.patch)));
      const auto on = patches.scatter(hit.patch, patches.scatters_through(hit.patch) ? random.uniform() : 0);
      flux = arrives * on.share;
      const double survival = luminous_mean(flux) / lands;
      if (!(random.uniform() < survival)) break;
      flux *= 1 / std::min(survival, 1.0);
      ray.origin = rays.off_surface(x, on.normal);
      const double u = random.uniform(), v = random.uniform();
      ray.direction = cosine_direction(Frame(on.normal), u, v);
    }
  }
  return ways;
}

void LandingsByPatch::sort(std::span<const ParticleWays> ways, std::size_t patches) {
  begin_.assign(patches + 1, 0);
  for (const ParticleWays& w : ways)
    for (const Landing& landing : w.landings) ++begin_[landing.patch + 1];
  for (std::size_t i = 0; i < patches; ++i) begin_[i + 1] += begin_[i];
  landings_.resize(begin_.back());
  for (const ParticleWays& w : ways)
    for (const Landing& landing : w.landings) landings_[begin_[landing.patch]++] = landing;
  std::copy_backward(begin_.begin(), begin_.end() - 1, begin_.end());
  begin_.front() = 0;
}

}  // namespace clerestory
