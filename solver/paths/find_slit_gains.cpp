#include "solver/paths/find_slit_gains.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/openings/openings.h"
#include "solver/paths/path_tracer.h"

namespace clerestory {
namespace {

constexpr std::uint32_t kLines = 4096;       ///< through one slit
constexpr std::size_t kMostLines = 1 << 14;  ///< through all of them
constexpr unsigned kMostRays = 32;  ///< of a path, on the mean; where it is so bright that they hardly end, fewer
constexpr int kEnoughLines = 32;    ///< in a bin, to tell it from the others

/// Radiosity where lines end, by a path and as of the patch: sums of luminous means.
struct LineEnds {
  double there = 0, of_patch = 0;
  int count = 0;

  void add(const LineEnds& other) {
    there += other.there, of_patch += other.of_patch;
    count += other.count;
  }
  double ratio() const { return of_patch > 0 ? there / of_patch : 1; }
};

Ray line_through(const LightArea& slit, const RayScene& rays, std::uint64_t key, std::uint32_t k) {
  return ray_through(slit, -slit.normal, key, k, rays.lift());
}
std::uint64_t key_of(std::uint64_t seed, std::size_t slit) { return stream_key(seed, kSlitGains, slit); }

/// returns  radiosity where each of the lines ends
std::vector<float> light_behind(const Illumination& light, const LightArea& slit, std::uint32_t count,
                                std::uint64_t key, const Monitor& monitor) {
  const PatchSet& patches = light.problem.patches;
  const RayScene& rays = light.problem.rays;
  std::vector<float> there;
  unsigned long long cost = 0;
  for (std::uint32_t k = 0; k < count && cost < kMostRays * (k + 1000ull); ++k) {
    const Ray out = line_through(slit, rays, key, k);
    const Hit hit = rays.first_hit(patches, out);
    there.push_back(SlitLight::kNowhere);
    if (!hit.patch.valid()) continue;
    const Vec3 n = patches.normal[hit.patch];
    const auto u = sobol4(k, mix_bits(key));
    RandomStream random(key, k);
    const Spectrum E = trace_path(light, rays.off_surface(hit.position(out), n), n,
                                  path_start({u[0], u[1]}, k, mix_bits(key)), random, cost, monitor);
    if (monitor.should_stop()) break;  // a path that it ended is worth nothing
    there.back() = static_cast<float>(luminous_mean(patches.M[hit.patch] + patches.rho[hit.patch] * E));
  }
  return there;
}

/// returns  gains by bin
std::array<float, SlitGains::kBins> gains_behind(const Problem& problem, const Field& B, const LightArea& slit,
                                                 std::span<const float> there, std::uint64_t key) {
  std::array<LineEnds, SlitGains::kBins> ends;
  for (std::uint32_t k = 0; k < there.size(); ++k) {
    if (there[k] == SlitLight::kNowhere) continue;
    const Hit hit = problem.rays.first_hit(problem.patches, line_through(slit, problem.rays, key, k));
    if (hit.patch.valid()) ends[SlitGains::bin(slit, hit.first)].add({there[k], luminous_mean(B[hit.patch]), 1});
  }
  LineEnds all;
  for (const LineEnds& e : ends) all.add(e);
  std::array<float, SlitGains::kBins> gains;
  for (std::size_t b = 0; b < gains.size(); ++b)
    gains[b] = static_cast<float>(ends[b].count < kEnoughLines ? all.ratio() : ends[b].ratio());
  return gains;
}

std::vector<std::uint32_t> numbers_of_slits(const std::vector<LightArea>& openings) {
  std::vector<std::uint32_t> slits;
  for (std::uint32_t k = 0; k < openings.size(); ++k)
    if (is_slit(openings[k])) slits.push_back(k);
  return slits;
}

}  // namespace

SlitLight find_slit_light(const Problem& problem, std::uint64_t seed, const Monitor& monitor) {
  const std::vector<LightArea>& openings = problem.lights.openings;
  const std::vector<std::uint32_t> slits = numbers_of_slits(openings);
  if (slits.empty()) return {};
  const Illumination light(problem);
  const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(kLines, kMostLines / slits.size()));
  SlitLight found;
  found.there.resize(openings.size());
  parallel_for(slits.size(), 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t s = from; s < to; ++s)
      found.there[slits[s]] = light_behind(light, openings[slits[s]], count, key_of(seed, slits[s]), monitor);
  });
  return found;
}

SlitGains slit_gains(const Problem& problem, const Field& B, const SlitLight& light, std::uint64_t seed) {
  const std::vector<LightArea>& openings = problem.lights.openings;
  const std::vector<std::uint32_t> slits = numbers_of_slits(openings);
  if (slits.empty() || light.there.empty()) return {};
  SlitGains found;
  found.gain.resize(openings.size());
  for (auto& gains : found.gain) gains.fill(1);
  parallel_for(slits.size(), 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t s = from; s < to; ++s)
      found.gain[slits[s]] =
          gains_behind(problem, B, openings[slits[s]], light.there[slits[s]], key_of(seed, slits[s]));
  });
  return found;
}

Illumination gather_illumination_by_slits(const Problem& problem, const Field& B, const SlitLight& known,
                                          std::uint64_t seed, const Monitor& monitor) {
  Illumination light = gather_illumination(problem, B);
  light.slit_gains =
      slit_gains(problem, B, known.there.empty() ? find_slit_light(problem, seed, monitor) : known, seed);
  return light;
}

}  // namespace clerestory
