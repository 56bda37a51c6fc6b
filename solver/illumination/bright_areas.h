#pragma once
// Bright patches that lie together in a plane: lamps and sunlit spots, as one area to look at.

#include <vector>

#include "solver/illumination/light_sampler.h"
#include "solver/lights/lights.h"

namespace clerestory {

/// The given patches, by what hangs together: they share corners and face the same way.
std::vector<std::vector<std::uint32_t>> plane_groups(const PatchSet& patches, const std::vector<std::uint32_t>& of);

struct BrightAreas {
  std::vector<LightArea> shape;  ///< hull of each bright area's patches; the normal is theirs, brightness their mean
  std::vector<double> flux;      ///< that bright patches of each send [W]
  std::vector<std::uint32_t> of_patch;  ///< N, bright area or kNone; empty without any
  double ambient = 0;                   ///< mean radiosity of all other patches [W/m2]
  double all_flux = 0;                  ///< of all bright patches, in bright areas or not
  static constexpr std::uint32_t kNone = 0xffffffff;

  std::uint32_t of(PatchId p) const { return of_patch.empty() ? kNone : of_patch[p]; }
};

/// The bright areas that send most, up to 64: bright patches of `sampler` that share corners and a plane, where they
/// fill at least a third of their hull. Where all light leaves no more than four planes, these, however bright:
/// bright patches are told by the median, which fails where most of all area is bright.
BrightAreas find_bright_areas(const PatchSet& patches, const LightSampler& sampler);

}  // namespace clerestory
