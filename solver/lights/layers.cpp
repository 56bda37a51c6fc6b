#include "solver/lights/layers.h"

#include <algorithm>

namespace clerestory {

std::vector<Layer> layers_by_group(const Lights& lights, bool surfaces_glow) {
  const std::size_t luminaires = lights.luminaires.size(), all = luminaires + lights.suns.size();
  std::vector<Layer> layers;
  for (std::size_t k = 0; k < luminaires; ++k) {
    const std::string& group = lights.luminaires[k].group;
    auto layer = std::ranges::find(layers, group, &Layer::name);
    if (layer == layers.end()) {
      layers.push_back({.name = group, .lights = std::vector<Spectrum>(all), .sky = {}});
      layer = layers.end() - 1;
    }
    layer->lights[k] = Spectrum(1.0);
  }
  if (lights.sky || !lights.suns.empty()) {
    Layer daylight{.name = "daylight", .lights = std::vector<Spectrum>(all), .sky = {}};
    std::fill(daylight.lights.begin() + static_cast<std::ptrdiff_t>(luminaires), daylight.lights.end(), Spectrum(1.0));
    if (lights.sky) daylight.sky = std::make_shared<const SkyRadiance>(lights);
    layers.push_back(std::move(daylight));
  }
  if (surfaces_glow) layers.push_back({.name = "surfaces", .lights = {}, .surfaces = Spectrum(1.0), .sky = {}});
  return layers;
}

}  // namespace clerestory
