#pragma once
// Where the rays of a final gather go, made once for all points.

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "solver/model/vec.h"
#include "solver/sampling/area_cells.h"

namespace clerestory {

/// Strata of the unit square, and how many rays go through each: 2^least() where the view is even, up to 2^deepest()
/// where a pilot sees its neighbours differ.
struct RayBudget {
  int grid;       ///< grid x grid strata, a power of 2, at least 8
  int rays;       ///< where the view is even: grid x grid x a power of 2
  int most_rays;  ///< about so many where it is not; no more than `rays`: no pilot

  int strata() const { return grid * grid; }
  int least() const;
  int deepest() const;
  /// Sixteen strata in a row lie together, so that they make a coherent packet.
  int stratum(int i, int j) const {
    const int tiles = grid / 4;
    return (i / 4 * tiles + j / 4) * 16 + i % 4 * 4 + j % 4;
  }
  int stratum_of(double u, double v) const { return stratum(static_cast<int>(u * grid), static_cast<int>(v * grid)); }
};

/// How many rays a point gets.
struct GatherQuality {
  RayBudget bundle;  ///< over the hemisphere
  AreaBudget area;   ///< to each opening and each bright area that matters
  int bright_rays;   ///< shadow rays to bright patches
  int sun_rays;      ///< to each sun
  /// Standard error of the bundle, as a share of all light at a point, above which it is sent anew with its most rays.
  double noise = std::numeric_limits<double>::infinity();
};

/// Cosine-distributed directions in the frame of the normal (z), by stratum of the unit square. Those of a stratum are
/// a sequence: its first 2^k are themselves well spread, all strata together, as the points of one Owen-scrambled Sobol
/// sequence are. Pilots are another sequence.
class Strata {
 public:
  Strata(const RayBudget& budget, std::uint64_t key, std::uint64_t pilot_key);

  const RayBudget& budget() const { return budget_; }
  /// The first 2^deepest directions of a stratum.
  std::span<const std::array<float, 3>> directions(int stratum) const {
    return std::span(fresh_).subspan(static_cast<std::size_t>(stratum) << deepest_, std::size_t{1} << deepest_);
  }
  const std::array<float, 3>& pilot(int stratum) const { return pilot_[static_cast<std::size_t>(stratum)]; }

 private:
  RayBudget budget_;
  int deepest_ = 0;
  std::vector<std::array<float, 3>> fresh_, pilot_;
};

/// All points use the same directions around their normal: what error is left then varies over a surface as smoothly as
/// the light, without grain, and directions cost nothing to make.
class GatherPattern {
 public:
  GatherPattern(const GatherQuality& quality, std::uint64_t seed);

  const GatherQuality& quality() const { return quality_; }
  const Strata& bundle() const { return bundle_; }
  const AreaCells& area_cells() const { return area_cells_; }
  /// Which bright patch, and where on it, for each ray at them.
  const std::vector<std::array<double, 3>>& bright_choices() const { return bright_choices_; }
  /// The same for pilot rays.
  static constexpr std::uint32_t kBrightPilots = 64;
  const std::vector<std::array<double, 3>>& bright_pilots() const { return bright_pilots_; }
  std::uint64_t sun_key() const { return sun_key_; }

  int stratum_of(const Frame& frame, const Vec3& direction) const;

 private:
  GatherQuality quality_;
  Strata bundle_;
  AreaCells area_cells_;
  std::vector<std::array<double, 3>> bright_choices_, bright_pilots_;
  std::uint64_t sun_key_;
};

}  // namespace clerestory
