#pragma once
// Mean irradiance of patches by luminaires and suns, which rays meet by chance only.

#include <cstdint>
#include <span>
#include <vector>

#include "solver/illumination/gloss_light.h"
#include "solver/illumination/light_rows.h"
#include "solver/illumination/problem.h"
#include "solver/lights/beam.h"

namespace clerestory {

struct DirectOptions {
  int shadow_rays = 16;  ///< shadow rays from a patch to each luminaire and sun
  int gloss_rays = 32;   ///< pairs from a patch that look for what glossy surfaces send on
  int edge_rays = 256;   ///< instead, where as many rays of a pilot disagree: the patch lies on the edge of a shadow
  int sky_rays = 256;    ///< cosine rays a patch that look for the sky; 0: without sky but through openings
  std::uint64_t seed = 1;
  bool rough_first = true;  ///< with a deadline: all patches get a rough value, in case it comes before the good ones
};

/// What a patch has of it, on the mean [W/m2].
struct DeltaIrradiance {
  Spectrum luminaires{0.0}, suns{0.0};
  GlossIrradiance by_gloss{};

  Spectrum sum() const { return luminaires + suns + by_gloss.sum(); }
};

std::vector<Beam> beams_of(const Lights& lights);

/// gloss  of the problem. beams: of the luminaires. row: null, or where to add what is found, by light.
DeltaIrradiance delta_light_of_patch(const Problem& problem, const GlossLight& gloss, std::span<const Beam> beams,
                                     std::size_t patch, const DirectOptions& options, LightRow* row);

/// The sum of that for some of the problem's patches, one value each [W/m2].
Field delta_light_on(const Problem& problem, std::span<const std::uint32_t> patches, const DirectOptions& options);

}  // namespace clerestory
