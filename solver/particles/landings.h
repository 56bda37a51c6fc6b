#pragma once
// Particles on their way: from surface to surface until roulette ends them.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/monitor.h"
#include "solver/model/solution.h"
#include "solver/particles/emission.h"

namespace clerestory {

/// A particle that arrives at a patch. 28 bytes.
struct Landing {
  std::array<float, 3> position;  ///< [m]
  std::array<float, 3> flux;      ///< by channel, of as many particles as were followed [W]
  std::uint32_t patch;
};

/// What some particles did.
struct ParticleWays {
  std::vector<Landing> landings;  ///< in the order of the particles
  EnergyBalance energy;           ///< summed over the particles: over their number it is that of the light [W]
  unsigned long long rays = 0;
};

/// Follows particles first ... first + count - 1 of the sequence `key`: each lands, and goes on with the probability of
/// its albedo, in luminous mean, so its luminous flux stays what it was; glass and mirrors turn it (one_way()).
///
/// monitor  asked now and then, for a way may have millions of bounces. Ask it, too: ways that it stopped are not
/// whole.
ParticleWays follow_particles(const Illumination& light, const Emission& emission, std::uint64_t key,
                              std::uint32_t first, std::uint32_t count, const Monitor& monitor = {});

/// Landings of several runs, patch by patch, each patch's in their order.
class LandingsByPatch {
 public:
  LandingsByPatch() = default;
  /// Puts in those of `ways`, instead of what was there before.
  void sort(std::span<const ParticleWays> ways, std::size_t patches);
  std::span<const Landing> operator[](std::size_t patch) const {
    return std::span(landings_).subspan(begin_[patch], begin_[patch + 1] - begin_[patch]);
  }

 private:
  std::vector<std::size_t> begin_;  ///< N + 1
  std::vector<Landing> landings_;
};

}  // namespace clerestory
