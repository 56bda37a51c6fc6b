#pragma once
// The directions of a final gather, made once for all points.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

/// How many rays a point gets. Defaults suit a sensor.
struct GatherQuality {
  int grid = 16;         ///< the hemisphere is grid x grid strata, a power of 2, at least 4
  int rays = 1024;       ///< where the view is even: grid x grid x a power of 2
  int most_rays = 4096;  ///< about so many where a pilot sees its neighbours differ; no more than `rays`: no pilot
  int lamp_rays = 128;   ///< shadow rays to bright patches, a multiple of 16
  int sun_rays = 16;     ///< to each sun
};

/// Strata of the hemisphere and the rays in them. All points use the same directions around their normal: what error is
/// left then varies over a surface as smoothly as the light, without grain, and directions cost nothing to make.
///
/// The rays of a stratum are a sequence: its first 2^k are themselves well spread, all strata together, as the points
/// of one Owen-scrambled Sobol sequence are. Pilot rays are another sequence.
class GatherPattern {
 public:
  GatherPattern(const GatherQuality& quality, std::uint64_t seed);

  const GatherQuality& quality() const { return quality_; }
  int strata() const { return quality_.grid * quality_.grid; }
  /// A stratum that the view asks for gets no more than 2^deepest() rays, one that it does not 2^least().
  int least() const { return least_; }
  int deepest() const { return deepest_; }

  /// First 2^deepest directions of a stratum in the frame of the normal (z), cosine-distributed.
  std::span<const std::array<float, 3>> directions(int stratum) const {
    return std::span(fresh_).subspan(static_cast<std::size_t>(stratum) << deepest_, std::size_t{1} << deepest_);
  }
  const std::array<float, 3>& pilot(int stratum) const { return pilot_[static_cast<std::size_t>(stratum)]; }
  /// Which light, and where on it, for each lamp ray.
  const std::vector<std::array<double, 3>>& lamp_choices() const { return lamp_choices_; }
  std::uint64_t sun_key() const { return sun_key_; }

  int stratum_of(const Frame& frame, const Vec3& direction) const;
  /// Sixteen strata in a row lie together, so that they make a coherent packet.
  int stratum(int i, int j) const {
    const int tiles = quality_.grid / 4;
    return (i / 4 * tiles + j / 4) * 16 + i % 4 * 4 + j % 4;
  }

 private:
  GatherQuality quality_;
  int least_ = 0, deepest_ = 0;
  std::vector<std::array<float, 3>> fresh_, pilot_;
  std::vector<std::array<double, 3>> lamp_choices_;
  std::uint64_t sun_key_;
};

}  // namespace clerestory
