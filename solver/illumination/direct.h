#pragma once
// Light that reaches the patches from sky, sun and luminaires without a bounce.

#include <span>
#include <vector>

#include "solver/illumination/delta_light.h"
#include "solver/illumination/illumination.h"
#include "solver/illumination/light_rows.h"
#include "solver/model/monitor.h"
#include "solver/model/solution.h"

namespace clerestory {

/// Which openings rays of their own look through, by patch: of patch i number[begin[i]] ... number[begin[i + 1] - 1].
/// Both are empty without any.
struct OpeningsOfPatches {
  std::vector<std::uint32_t> begin, number;

  std::span<const std::uint32_t> of(std::size_t patch) const {
    if (begin.empty()) return {};
    return std::span(number).subspan(begin[patch], begin[patch + 1] - begin[patch]);
  }
};

struct DirectLight {
  Field E;  ///< N x channels, mean irradiance of each patch [W/m2]
  /// N x channels, the part of the sky's that comes straight through an opening looked at by its own rays; bundles
  /// leave it out. Part of E when DirectOptions has sky rays [W/m2].
  Field E_openings;
  OpeningsOfPatches openings;  ///< those looked at, by patch
  EnergyBalance energy;  ///< emitted: luminaires' flux, and what sky and sun bring in; escaped and absorbed (by glass
                         ///< and sides that take no part): the part of the luminaires' flux that misses the patches
  unsigned long long rays = 0;
};

/// Patches of which many were there before: of them the sky through openings need not be looked for again.
struct PatchesOfRound {
  static constexpr std::uint32_t kNew = 0xffffffff;
  std::span<const std::uint32_t> name;  ///< by patch: it keeps it, and with it the rays through openings
  std::uint64_t seed = 1;               ///< of these rays, in all rounds
  const DirectLight* before = nullptr;  ///< what was found then; null: nothing
  std::vector<std::uint32_t> number;    ///< by patch: of the same patch then, or kNew
};

/// A luminaire or sun of whose light rows tell.
struct DirectSource {
  Spectrum flux;         ///< a luminaire's; of a sun what it brings in, as of the scene's sky [W]
  EnergyBalance energy;  ///< as of DirectLight

  /// Its part in the balance of a layer.
  EnergyBalance energy_at(const Spectrum& factor) const;
};

/// Direct light by what it comes from: the same rays for other light.
struct DirectRows {
  LightRows rows;                     ///< by patch: luminaires, suns, and sky where rays of their own look for it
  std::vector<DirectSource> sources;  ///< numbered as in Layer::lights

  /// Luminaires that were looked at by themselves, over the same patches; their numbers follow.
  void append(const DirectRows& more);
};

/// Points are spread over each patch, so that the edge of a shadow gives a patch its lit share. Looking twice at edges
/// favours all lit and all dark alike, by less than 0.03 of a patch, which cancels along an edge.
///
/// rows   where it is not null: filled with what the rays found, 16 bytes for each luminaire and sun that reaches a
///        patch, and for each ray of the patch that looks for the sky.
/// round  null, or what may be taken over where there are no rows, with the same bits
DirectLight direct_light(const Illumination& light, const DirectOptions& options, const Monitor& monitor = {},
                         DirectRows* rows = nullptr, const PatchesOfRound* round = nullptr);

/// Direct light of layers, N x lanes [W/m2].
struct DirectLayers {
  Field delta_light;                  ///< of luminaires and suns
  Field sky;                          ///< where rays of their own look for it
  std::vector<EnergyBalance> energy;  ///< by layer, as of DirectLight: what comes from the sky is emitted, too
};
DirectLayers direct_layers(const PatchSet& patches, const DirectRows& rows, std::span<const Layer> layers);

}  // namespace clerestory
