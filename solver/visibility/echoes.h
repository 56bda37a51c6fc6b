#pragma once
// Rays that panes of glass have turned back, to where they end.

#include <algorithm>
#include <cstdint>

#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// Random numbers for the echoes of the ray that stream `key` numbers k.
inline RandomStream echo_numbers(std::uint64_t key, std::uint64_t k) { return {kEchoes, key, k}; }

/// Calls found(hit) for where an echo ends, and for where echoes of it end: hit.transmittance is the share of the first
/// ray's light that comes from there. Only the first always has a hit; another follows by roulette, with the share that
/// glass on the way turned back for its chance, so that nothing is lost on the mean. What gloss sends on is followed
/// while it is more than kMuch of the first ray's light: most of a polished room's is.
template <class Found>
void follow_echo(const RayScene& rays, const PatchSet& patches, const Echo& first, RandomStream& random,
                 const Found& found) {
  Echo echo = first, next;
  while (!echo.is_none()) {
    Hit hit = rays.first_hit(patches, echo.ray, &next);
    hit.transmittance *= echo.share;
    hit.plane = hit.reflected ? kNoPlane : echo.plane;
    if (!hit.reflected) hit.reflected = true, hit.leg = echo.ray;
    found(hit);
    constexpr double kMuch = 0.1;
    const double chance = next.by_gloss ? luminous_mean(echo.share * next.share) / kMuch : luminous_mean(next.share);
    if (!(random.uniform() < chance)) return;
    next.share *= echo.share * (1 / std::min(chance, 1.0));
    next.plane = kNoPlane;
    echo = next;
  }
}

/// The same for the ray that stream `key` numbers k, and nothing where there is no echo.
template <class Found>
void follow_echo(const RayScene& rays, const PatchSet& patches, const Echo& first, std::uint64_t key, std::uint64_t k,
                 const Found& found) {
  if (first.is_none()) return;
  RandomStream random = echo_numbers(key, k);
  follow_echo(rays, patches, first, random, found);
}

/// Instead of a ray's hit and its echoes: one of them, the way that the light of one ray takes. It keeps what the hit
/// of its kind has on the mean. Once turned it ends by roulette with what glass took for its chance, so that it leaves
/// glass that lets nothing pass: with a black hit without a patch. A lobe is weighed against what the surface scatters
/// and no more, or ways from lobe to lobe would grow without bound.
inline Hit one_way(const RayScene& rays, const PatchSet& patches, const Ray& ray, RandomStream& random) {
  Echo echo;
  Hit hit = rays.first_hit(patches, ray, &echo);
  if (echo.is_none()) return hit;
  Spectrum share(1.0);
  Ray leg = ray;
  for (bool turned = false;; turned = true) {
    constexpr double kLeastAlbedo = 0.1;  // what lands on a metal is asked for, too
    const double on = luminous_mean(hit.transmittance) *
                      (echo.by_gloss && hit.patch.valid()
                           ? std::max(kLeastAlbedo, luminous_mean(patches.albedo(hit.patch)))
                           : 1.0),
                 back = luminous_mean(echo.share);
    const bool goes_on = echo.is_none() || (random.uniform() * (on + back) >= back && on > 0);
    if (goes_on) {
      hit.transmittance *= share * (echo.is_none() ? 1.0 : (on + back) / on);
      if (turned && !hit.reflected) hit.reflected = true, hit.leg = leg;
      return hit;
    }
    share *= echo.share * ((on + back) / back);
    const double chance = luminous_mean(share);
    if (!(random.uniform() < chance)) {
      hit.patch = {}, hit.transmittance = Spectrum(0.0);
      return hit;
    }
    share *= 1 / std::min(chance, 1.0);
    leg = echo.ray;
    hit = rays.first_hit(patches, leg, &echo);
  }
}

}  // namespace clerestory
