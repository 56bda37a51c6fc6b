#pragma once
// The energy balance of a solution, patch by patch.

#include <cstddef>

#include "solver/model/patch_set.h"
#include "solver/model/solution.h"
#include "solver/spaces/closure.h"

namespace clerestory {

/// Shares of what a patch sends out that reach no patch [1], by channel.
struct Losses {
  Spectrum escapes;  ///< leaves the scene
  Spectrum lost;     ///< absorbed by glass and sides that take no part
};

/// What neither arrives nor escapes is lost. Shares that rays counted may sum to a little more than 1; nothing is lost
/// then. Where there is gloss they do: light that its lobes send on arrives again, and what is lost is less than
/// nothing, as the glossy patch is said to have absorbed it.
Losses losses(const Spectrum& arrives, const Spectrum& escapes, bool has_gloss);
inline Losses losses(const Closure& closure, std::size_t i) {
  return losses(closure.arrives[i], closure.escapes[i], closure.has_gloss);
}

/// Where the light ends that arrives at patch i as E and leaves it as B [W/m2], luminous mean:
///   absorbed = A ((1 - albedo) E + lost B),     escaped = A escapes B.
/// Summed over all patches that is the balance of any E and B, for methods that know their losses by the patch. Nothing
/// is emitted here.
EnergyBalance where_light_ends(const PatchSet& patches, std::size_t i, const Spectrum& E, const Spectrum& B,
                               const Losses& loss);

}  // namespace clerestory
