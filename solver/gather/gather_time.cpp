#include "solver/gather/gather_time.h"

#include <algorithm>
#include <chrono>

namespace clerestory {

double seconds_a_gather(const Illumination& light, const Gathers& gathers, std::uint64_t seed) {
  constexpr std::size_t kFew = 64;
  const std::size_t few = std::min(gathers.count, kFew);
  if (few == 0) return 0;
  const GatherPattern pattern(gathers.quality, seed);
  const auto start = std::chrono::steady_clock::now();
  gather_at(
      light, few, [&](std::size_t k) { return gathers.place((2 * k + 1) * gathers.count / (2 * few)); }, pattern, "");
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / static_cast<double>(few);
}

GatherQuality quality_in_time(const Illumination& light, Gathers gathers, std::span<const GatherQuality> qualities,
                              double seconds, std::uint64_t seed) {
  for (const GatherQuality& quality : qualities) {
    gathers.quality = quality;
    if (&quality == &qualities.back()) break;
    if (static_cast<double>(gathers.count) * seconds_a_gather(light, gathers, seed) <= seconds) break;
  }
  return gathers.quality;
}

}  // namespace clerestory
