#include "solver/methods/kept_transport.h"

#include <utility>
#include <vector>

#include "solver/hierarchy/sky_views.h"
#include "solver/model/assert.h"

namespace clerestory {
Balanced solve_for(const KeptTransport& kept, std::span<const Layer> layers, double residual, const Monitor& monitor) {
  CLERESTORY_ASSERT(kept.complete, ==, true);
  CLERESTORY_ASSERT(layers.size(), >, 0u);
  const PatchSet& patches = kept.elements;
  const int channels = patches.channels;
  DirectLayers direct = direct_layers(patches, kept.direct, layers);
  Field E_direct = std::move(direct.delta_light);
  for (std::size_t k = 0; k < E_direct.value.size(); ++k) E_direct.value[k] += direct.sky.value[k];
  std::vector<const SkyRadiance*> skies;
  std::vector<std::size_t> under;  // number of the layer, by sky
  for (std::size_t s = 0; s < layers.size(); ++s)
    if (layers[s].sky) skies.push_back(layers[s].sky.get()), under.push_back(s);
  if (!skies.empty()) {
    const Field E_sky = sky_irradiance(patches, kept.tree, kept.transport, skies);
    for (std::size_t k = 0; k < skies.size(); ++k) {
      const Field sky = one_layer(E_sky, k, channels);
      for (std::size_t i = 0; i < sky.size(); ++i)
        for (int c = 0; c < channels; ++c) E_direct.at(i, static_cast<int>(under[k]) * channels + c) += sky.at(i, c);
      direct.energy[under[k]].emitted += total_flux(patches, sky);
    }
  }
  const Field M = exitance(patches, layers);
  Balanced s = balance(patches, kept.tree, kept.transport, M, E_direct, {}, residual, monitor);
  for (std::size_t k = 0; k < layers.size(); ++k) {
    s.energy[k] += direct.energy[k];
    s.energy[k].emitted += total_flux(patches, one_layer(M, k, channels));
  }
  return s;
}

}  // namespace clerestory
