#include "solver/spaces/energy.h"

#include <algorithm>

#include "solver/model/units.h"

namespace clerestory {

Losses losses(const Spectrum& arrives, const Spectrum& escapes, bool has_gloss) {
  const Spectrum lost = Spectrum(1.0) - arrives - escapes;
  if (has_gloss) return {escapes, lost};
  return {escapes, {std::max(0.0, lost[0]), std::max(0.0, lost[1]), std::max(0.0, lost[2])}};
}

EnergyBalance where_light_ends(const PatchSet& patches, std::size_t i, const Spectrum& E, const Spectrum& B,
                               const Losses& loss) {
  const Spectrum absorbed = (Spectrum(1.0) - patches.albedo(i)) * E + loss.lost * B;
  return {.absorbed = patches.area[i] * luminous_mean(absorbed),
          .escaped = patches.area[i] * luminous_mean(loss.escapes * B)};
}

}  // namespace clerestory
