#pragma once
// Landings of particles from all lights, by how they came.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/particles/landings.h"

namespace clerestory::test {

/// Of `particles` particles those whose way is one of `wanted`, each with its share of the light's flux. Same for any
/// thread count.
inline std::vector<Landing> send_photons(const Illumination& light, std::size_t particles,
                                         std::span<const ParticleWay> wanted, std::uint64_t seed) {
  const Emission emission(light);
  constexpr std::size_t kBlock = 1 << 10, kRound = 256;
  const std::size_t blocks = (particles + kBlock - 1) / kBlock;
  std::vector<Landing> photons;
  double followed = 0;
  for (std::size_t begin = 0; begin < blocks; begin += kRound) {
    std::vector<ParticleWays> ways(std::min(kRound, blocks - begin));
    parallel_for(ways.size(), 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t b = from; b < to; ++b) {
        const std::size_t first = (begin + b) * kBlock;
        ways[b] = follow_particles(light, emission, stream_key(seed, 0x53), static_cast<std::uint32_t>(first),
                                   static_cast<std::uint32_t>(std::min(kBlock, particles - first)));
        std::erase_if(ways[b].landings,
                      [&](const Landing& l) { return std::ranges::find(wanted, l.way()) == wanted.end(); });
      }
    });
    followed = static_cast<double>(std::min((begin + ways.size()) * kBlock, particles));
    for (const ParticleWays& w : ways) photons.insert(photons.end(), w.landings.begin(), w.landings.end());
  }
  for (Landing& photon : photons)
    for (float& flux : photon.flux) flux = static_cast<float>(flux / followed);
  return photons;
}

}  // namespace clerestory::test
