#pragma once
// How long gathers take, told by a few of them.

#include <cstdint>
#include <span>

#include "solver/gather/gather.h"

namespace clerestory {

struct Gathers {
  std::size_t count = 0;
  PointOf place{};
  GatherQuality quality{};
};

/// Seconds that one of them takes on all threads together, by 64 spread over the places; 0 where there are none.
///
/// light  made for a gather, see gather_illumination().
double seconds_a_gather(const Illumination& light, const Gathers& gathers, std::uint64_t seed);

/// The first of these qualities by which the gathers take up to so many seconds; the last where none does.
GatherQuality quality_in_time(const Illumination& light, Gathers gathers, std::span<const GatherQuality> qualities,
                              double seconds, std::uint64_t seed);

}  // namespace clerestory
