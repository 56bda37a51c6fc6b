#pragma once
// Progressive radiosity: shooting, with an ambient term for what is not shot yet.

#include <cstdint>

#include "solver/illumination/direct.h"
#include "solver/illumination/problem.h"
#include "solver/model/monitor.h"
#include "solver/model/solution.h"
#include "solver/spaces/closure.h"

namespace clerestory {

struct ShootOptions {
  double stop_fraction = 3e-3;  ///< stop when unshot flux / emitted flux is below this [1], > 0
  double rays_per_patch = 256;  ///< rays spent on the emitted flux once, for each patch of the scene; sets the noise
  double batch_share = 0.25;    ///< patches shoot together that have at least this share of the largest unshot flux;
                                ///< 1: one patch a round, as the paper has it
  int max_rounds = 10'000;      ///< safety net; reaching it sets StopReason::iteration_limit
  std::uint64_t seed = 1;
};

/// Solves B = M + rho (E_direct + F B) by shooting, each round from the patches with the most unshot flux A dB.
///
/// A shot is a bundle of stratified cosine rays that carry equal flux, more of them the more flux there is to shoot;
/// every ray lands or escapes, so that no energy is lost or made, and a patch's later shots continue its sequence.
/// The ambient term e = sum A dB / sum A (1 - rho arrives), of each space that no light links to another, is the
/// uniform radiosity that would carry the unshot light; in a closed room of one reflectance it makes the mean exact
/// after every round. Once the unshot light is spread so evenly that e explains most of it, e is shot for good: a
/// uniform radiosity needs no rays, it gives every patch arrives_i e. What stays unshot may then be negative, and is
/// shot just the same. So rho = 0.9999 needs no more rounds than 0.5.
///
/// returns  B, E [W/m2] with the ambient term in E; residual = unshot / emitted flux without it.
/// Threads: same bits for any thread count. Cost: rays_per_patch x N rays for each time the light goes round.
/// Source: Cohen, Chen, Wallace & Greenberg, "A progressive refinement approach to fast radiosity image generation",
/// 1988; overshooting the ambient: Feda & Purgathofer, "Accelerating radiosity by overshooting", 1992.
Solution shoot(const Problem& problem, const DirectLight& direct, const Closure& closure,
               const ShootOptions& options = {}, const Monitor& monitor = {});

}  // namespace clerestory
