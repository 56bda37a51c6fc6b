#include "solver/particles/landings.h"

#include <algorithm>

#include "solver/model/random_stream.h"
#include "solver/model/units.h"
#include "solver/sampling/packed_direction.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

constexpr unsigned kLegsBetween = 1 << 12;  // between looks at the monitor: some milliseconds

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
    ParticleWay way = ParticleWay::straight;
    for (unsigned leg = 0;; ++leg) {
      if (leg % kLegsBetween == kLegsBetween - 1 && monitor.should_stop()) return ways;
      Echo echo;
      const Hit hit = rays.first_hit(patches, ray, &echo);
      ++ways.rays;
      if (hit.reflected && way == ParticleWay::straight) way = ParticleWay::turned;
      const Spectrum arrives = flux * hit.transmittance, turns_back = flux * echo.share;
      const double before = luminous_mean(flux), lands = luminous_mean(arrives);
      // Of sun and sky counts what arrives on anything.
      if (from_outside && leg == 0) ways.energy.emitted += hit.escaped() ? before - lands : before;
      if (hit.escaped() && (!from_outside || leg > 0)) ways.energy.escaped += lands;

      // It lands with all that arrives, and goes on either from there or as what was turned back: each in proportion to
      // its flux, which stays what it was.
      const bool lands_on_patch = hit.patch.valid() && lands > 0;
      PatchSet::Scattering on{{}, Spectrum(0.0)};
      Vec3 x;
      if (lands_on_patch) {
        x = in_plane_of(patches, hit.patch, hit.position(ray));
        ways.landings.push_back(
            {{static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)},
             {static_cast<float>(arrives[0]), static_cast<float>(arrives[1]), static_cast<float>(arrives[2])},
             hit.patch.value,
             pack_direction(-hit.direction(ray)) | static_cast<std::uint32_t>(way) << kDirectionBits});
        on = patches.scatter(hit.patch, patches.scatters_through(hit.patch) ? random.uniform() : 0);
      }
      const Spectrum scattered = arrives * on.share;
      const double goes_on = luminous_mean(scattered), goes_back = luminous_mean(turns_back);
      const double reflects = lands_on_patch ? luminous_mean(arrives * patches.albedo(hit.patch)) : 0;
      ways.energy.absorbed += before - reflects - goes_back - (hit.escaped() ? lands : 0);
      const double pick = random.uniform() * std::max(before, goes_on + goes_back);
      if (pick < goes_on) {
        flux = scattered * (std::max(before, goes_on + goes_back) / goes_on);
        ray.origin = rays.off_surface(x, on.normal);
        const double u = random.uniform(), v = random.uniform();
        ray.direction = cosine_direction(Frame(on.normal), u, v);
        way = ParticleWay::scattered;
      } else if (pick < goes_on + goes_back) {
        flux = turns_back * (std::max(before, goes_on + goes_back) / goes_back);
        ray = echo.ray;
        if (way == ParticleWay::straight) way = ParticleWay::turned;
      } else {
        break;
      }
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
