#pragma once
// Right-hand sides: distributions of light that one transport is balanced for, side by side.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "solver/lights/lights.h"
#include "solver/lights/sky.h"
#include "solver/model/patch_set.h"

namespace clerestory {

/// How much there is of each light.
struct Layer {
  std::string name;
  std::vector<Spectrum> lights;     ///< factor on each luminaire, then on each sun, as Lights numbers them; 0 beyond
  std::vector<Spectrum> materials;  ///< factor on what surfaces of each material emit, by MaterialId; 0 beyond
  std::shared_ptr<const SkyRadiance> sky;  ///< none: dark

  /// Factor on what surfaces of that material emit.
  Spectrum of_material(MaterialId m) const { return m < materials.size() ? materials[m] : Spectrum(0.0); }
};

// Names of layers that no group has given its own. Sky and sun are no luminaires, so no group may be called so.
inline constexpr const char* kSkyLayer = "sky";                ///< with the virtual ground as the sky lights it
inline constexpr const char* kSunLayer = "sun";                ///< all suns, and the virtual ground as they light it
inline constexpr const char* kLuminairesLayer = "luminaires";  ///< those without a group
inline constexpr const char* kEmissionLayer = "emission";      ///< glowing materials without a group

/// Why a group of that name cannot be a layer, with what to do; empty when it can.
std::string problem_with_group(std::string_view group);

/// Layers that sum to all light of the scene: luminaires (images go with what they show) and glowing materials by their
/// group, in the order of the groups' first luminaires, then materials; then sky, sun and what glows without a group.
/// Those that the scene has not are left out.
std::vector<Layer> layers_by_group(const Lights& lights, const PatchSet& patches);

/// What surfaces emit in each layer, N x lanes [W/m2].
Field exitance(const PatchSet& patches, std::span<const Layer> layers);

}  // namespace clerestory
