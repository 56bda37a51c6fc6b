#pragma once
// Where photometric and radiometric quantities meet, and lengths of other units become metres.

#include <numbers>

#include "solver/model/channels.h"

namespace clerestory {

inline constexpr double kWhiteEfficacy = 179.0;  ///< [lm/W] uniform white light; joins W/m2 and lx

/// Luminance weights of linear R, G, B; they sum to 1, so grey light keeps its 179 lm/W.
inline constexpr Spectrum kLuminousWeights{0.2651, 0.6701, 0.0648};

/// Channel-weighted mean of s, in s's own unit.
constexpr double luminous_mean(const Spectrum& s) {
  return kLuminousWeights[0] * s[0] + kLuminousWeights[1] * s[1] + kLuminousWeights[2] * s[2];
}
/// Illuminance [lx] of irradiance E [W/m2]; also luminous exitance [lm/m2] of exitance, luminance [cd/m2] of radiance.
constexpr double photometric(const Spectrum& E) { return kWhiteEfficacy * luminous_mean(E); }
/// Luminance [cd/m2] of a diffuse surface of radiosity B [W/m2].
constexpr double luminance_of_radiosity(const Spectrum& B) { return photometric(B) / std::numbers::pi; }

}  // namespace clerestory
