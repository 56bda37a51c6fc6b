#include "solver/lights/layers_of_times.h"

#include <algorithm>

#include "solver/model/light_of_times.h"

namespace clerestory {

namespace {

/// Legs of the light that is there at time t: of suns those of its own, as strong as they are then.
std::vector<CausticLeg> legs_at(const Lights& mean, std::size_t t) {
  const std::size_t luminaires = mean.luminaires.size();
  std::vector<std::uint32_t> number(mean.suns.size(), CausticLeg::kNone);  // among the suns of the time
  std::uint32_t count = 0;
  for (std::size_t k = 0; k < mean.suns.size(); ++k)
    if (!mean.suns[k].time || *mean.suns[k].time == t) number[k] = count++;
  std::vector<CausticLeg> legs;
  for (CausticLeg leg : std::span<const CausticLeg>(mean.caustics.legs)) {
    if (leg.light >= luminaires) {
      const std::size_t k = leg.light - luminaires;
      if (number[k] == CausticLeg::kNone) continue;
      if (mean.suns[k].time)
        for (float& flux : leg.flux) flux *= static_cast<float>(mean.times);
      leg.light = static_cast<std::uint32_t>(luminaires) + number[k];
    }
    legs.push_back(leg);
  }
  return legs;
}

}  // namespace

Lights lights_at(const Lights& mean, std::size_t t) {
  Lights lights = mean;
  lights.caustics.legs = legs_at(mean, t);
  lights.sky = sky_at(mean.sky, t);
  lights.suns = suns_at(mean.suns, mean.times, t);
  lights.times = 1;
  return lights;
}

std::vector<Layer> layers_of_times(const Lights& mean, const PatchSet& patches) {
  const std::size_t luminaires = mean.luminaires.size();
  const double share = 1 / static_cast<double>(mean.times);
  Lights of_sky = mean;
  of_sky.caustics = {};
  std::vector<Layer> layers(mean.times);
  for (std::size_t t = 0; t < mean.times; ++t) {
    Layer& layer = layers[t];
    layer.lights.assign(luminaires + mean.suns.size(), Spectrum(0.0));
    std::fill_n(layer.lights.begin(), luminaires, Spectrum(share));
    for (std::size_t k = 0; k < mean.suns.size(); ++k) {
      const std::optional<std::size_t>& own = mean.suns[k].time;
      if (!own || *own == t) layer.lights[luminaires + k] = Spectrum(own ? 1 : share);
    }
    layer.materials.assign(patches.materials.size(), Spectrum(share));
    if (mean.sky) layer.sky = std::make_shared<const SkyRadiance>(lights_at(of_sky, t), share);
  }
  return layers;
}

}  // namespace clerestory
