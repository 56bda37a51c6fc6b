#include "solver/lights/layers.h"

#include <algorithm>

namespace clerestory {
namespace {

class Layers {
 public:
  explicit Layers(std::size_t lights) : lights_(lights) {}

  Layer& named(std::string_view name) {
    const auto layer = std::ranges::find(all, name, &Layer::name);
    if (layer != all.end()) return *layer;
    return all.emplace_back(Layer{std::string(name), std::vector<Spectrum>(lights_), {}, {}});
  }

  std::vector<Layer> all;

 private:
  std::size_t lights_;
};

/// By MaterialId, whether a patch of it emits.
std::vector<bool> glowing(const PatchSet& patches) {
  std::vector<bool> glows(patches.materials.size());
  for (std::size_t i = 0; i < patches.patch_count(); ++i)
    if (!patches.M[i].is_black()) glows[patches.material(PatchId{i})] = true;
  return glows;
}

SkyRadiance radiance(const Sky& sky, std::span<const PlacedSun> suns) {
  Lights lights;
  lights.sky = sky;
  lights.suns.assign(suns.begin(), suns.end());
  return SkyRadiance(lights);
}

}  // namespace

std::string problem_with_group(std::string_view group) {
  if (group == kSkyLayer || group == kSunLayer)
    return "is the name of the layer of the " + std::string(group) + "; give the group another";
  const auto is_bad = [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return code < 0x20 || code == 0x7f || std::string_view("=<&\"").find(c) != std::string_view::npos;
  };
  if (std::ranges::any_of(group, is_bad))
    return "has one of the characters = < & \" or a control character, which names of layers cannot have; leave it out";
  return {};
}

std::vector<Layer> layers_by_group(const Lights& lights, const PatchSet& patches) {
  const std::size_t luminaires = lights.luminaires.size();
  Layers layers(luminaires + lights.suns.size());
  for (std::size_t k = 0; k < luminaires; ++k) {
    const std::string& group = lights.luminaires[k].group;
    layers.named(group.empty() ? kLuminairesLayer : group).lights[k] = Spectrum(1.0);
  }
  const std::vector<bool> glows = glowing(patches);
  const auto add_material = [&](std::string_view name, std::size_t m) {
    Layer& layer = layers.named(name);
    layer.materials.resize(glows.size());
    layer.materials[m] = Spectrum(1.0);
  };
  for (std::size_t m = 0; m < glows.size(); ++m)
    if (const std::string& group = patches.materials[m].group; glows[m] && !group.empty()) add_material(group, m);
  if (lights.sky) layers.named(kSkyLayer).sky = std::make_shared<const SkyRadiance>(radiance(*lights.sky, {}));
  if (!lights.suns.empty()) {
    Layer& sun = layers.named(kSunLayer);
    std::fill(sun.lights.begin() + static_cast<std::ptrdiff_t>(luminaires), sun.lights.end(), Spectrum(1.0));
    if (lights.sky && !lights.sky->image_has_ground) {
      const Sky dark{.model = SkyModel::uniform,
                     .horizontal_irradiance = {},
                     .ground_reflectance = lights.sky->ground_reflectance};
      sun.sky = std::make_shared<const SkyRadiance>(radiance(dark, lights.suns));
    }
  }
  for (std::size_t m = 0; m < glows.size(); ++m)
    if (glows[m] && patches.materials[m].group.empty()) add_material(kEmissionLayer, m);
  return std::move(layers.all);
}

Field exitance(const PatchSet& patches, std::span<const Layer> layers) {
  Field M(patches.patch_count(), static_cast<int>(layers.size()) * patches.channels);
  for (std::size_t i = 0; i < M.size(); ++i)
    for (std::size_t s = 0; s < layers.size(); ++s) {
      const Spectrum factor = layers[s].of_material(patches.material(PatchId{i}));
      for (int c = 0; c < patches.channels; ++c)
        M.at(i, static_cast<int>(s) * patches.channels + c) = patches.M.at(i, c) * factor[c];
    }
  return M;
}

}  // namespace clerestory
