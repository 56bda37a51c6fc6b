#pragma once
// The light of several times in one: their mean, and what of it is of which time.

#include <cstddef>
#include <span>

#include "solver/model/light_spec.h"

namespace clerestory {

/// Mean of the times' light. Luminaires and suns of `always` shine at all of them.
///
/// times  T of them, at least one: sky and suns alone; skies that are no image may differ, and either all have one or
///        none. Where all have the same, it is the mean itself; else their mean is a sky of T parts.
/// returns  suns of a time with their share 1 / T of the mean, and its number
LightSpec mean_over_times(LightSpec always, std::span<const LightSpec> times);

/// The sky of time t of the mean.
std::optional<Sky> sky_at(const std::optional<Sky>& mean, std::size_t t);

/// The light of time t of the mean, all of it.
LightSpec light_at(const LightSpec& mean, std::size_t t);

/// The suns of time t of the mean, as they are then.
template <class AnySun>
std::vector<AnySun> suns_at(const std::vector<AnySun>& mean, std::size_t times, std::size_t t) {
  std::vector<AnySun> suns;
  for (const AnySun& sun : mean) {
    if (sun.time && *sun.time != t) continue;
    suns.push_back(sun);
    if (sun.time) suns.back().normal_irradiance *= static_cast<double>(times);
    suns.back().time = {};
  }
  return suns;
}

}  // namespace clerestory
