#pragma once
// How bright surfaces are where a slit sees them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "solver/lights/lights.h"

namespace clerestory {

/// Beside a slit, in the corner of wall and slab, a surface is darker than the mean of its element, and that corner is
/// what the slit sees most of: the radiosity there over that of the element, by the way from the slit.
struct SlitGains {
  static constexpr std::size_t kBins = 16;     ///< one width of the slit, two, four, ... and all beyond
  std::vector<std::array<float, kBins>> gain;  ///< by number in Lights::openings; empty: 1 all over

  /// distance  from the slit to what is seen through it [m]
  static std::size_t bin(const LightArea& slit, double distance);
  double of(std::uint32_t number, const LightArea& slit, double distance) const {
    return gain.empty() ? 1 : double{gain[number][bin(slit, distance)]};
  }
};

}  // namespace clerestory
