#pragma once
// Caustics: particles over surfaces that turn the light of luminaires and suns and show no image of them.

#include <cstdint>
#include <span>
#include <vector>

#include "solver/illumination/problem.h"
#include "solver/model/monitor.h"

namespace clerestory {

/// The problem's caustics, from so many particles. Their sides are those of mirrors whose plane has no number
/// (RayScene::plane_of), and of gloss that is narrow and in no plane that lights have images in: curved ones. Empty
/// where there are none, or no luminaire or sun.
///
/// problem        whose triangles are those of the rays.
/// with_gloss     false: for who finds light over gloss by himself.
Caustics find_caustics(const Problem& problem, std::size_t particles, std::size_t legs_of_point, std::uint64_t seed,
                       const Monitor& monitor = {}, bool with_gloss = true);

/// Sends particles from the lights, images among them, to the sides of Lights::caustics, and follows each over all that
/// turns it, by one way where there are several, until it ends on what scatters it alone or by roulette. Light that
/// meets anything else first is not among them: images and rays at gloss find it. So all light is found once.
///
/// key      of the random numbers.
/// returns  legs whose flux is a particle's share of the light, in the order of the particles: fewer than asked for
/// where
///          the monitor stopped it (never less than 32,768), or ways are long. Threads: same bits for any thread count.
///          Cost: 0.5 to 2 us a particle and core.
std::vector<CausticLeg> trace_caustics(const Problem& problem, std::size_t particles, std::uint64_t key,
                                       const Monitor& monitor = {});

/// Flux that arrives at a patch [W].
struct CausticLanding {
  PatchId patch;
  Vec3 place;               ///< local frame [m]
  Vec3 direction;           ///< unit, of its way
  std::uint32_t light = 0;  ///< as in CausticLeg
  Spectrum flux;
};
/// That a leg ends on; invalid where that is none of these.
PatchId patch_of(const PatchSet& patches, const CausticLeg& leg);
/// Of a leg; its patch is invalid where it ends on none of the problem's.
CausticLanding landing_of(const Problem& problem, const CausticLeg& leg);
/// Calls take(landing) where legs end on patches of the problem, in their order.
template <class Take>
void each_landing(const Problem& problem, std::span<const CausticLeg> legs, const Take& take) {
  for (const CausticLeg& leg : legs)
    if (const CausticLanding landing = landing_of(problem, leg); landing.patch.valid()) take(landing);
}

/// Irradiance of each patch by them, N x channels [W/m2].
Field caustics_on_patches(const Problem& problem, std::span<const CausticLeg> legs);

}  // namespace clerestory
