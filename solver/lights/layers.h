#pragma once
// Right-hand sides: distributions of light that one transport is balanced for, side by side.

#include <memory>
#include <string>
#include <vector>

#include "solver/lights/lights.h"
#include "solver/lights/sky.h"

namespace clerestory {

/// How much there is of each light.
struct Layer {
  std::string name;
  std::vector<Spectrum> lights;  ///< factor on each luminaire, then on each sun, as Lights numbers them; 0 beyond
  Spectrum surfaces{0.0};        ///< factor on what surfaces emit themselves
  std::shared_ptr<const SkyRadiance> sky;  ///< none: dark
};

/// Layers that sum to all light of the scene: luminaires by Luminaire::group (images go with what they show), in the
/// order of the groups' first luminaires; then "daylight", sky and suns, and "surfaces", where there are any.
std::vector<Layer> layers_by_group(const Lights& lights, bool surfaces_glow);

}  // namespace clerestory
