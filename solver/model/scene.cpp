#include "solver/model/scene.h"

#include "solver/model/units.h"

namespace clerestory {
namespace {

// Call visit(Spectrum&) for every colour.
template <class Materials, class Visit>
void for_each_colour_of_materials(Materials& materials, const Visit& visit) {
  for (auto& m : materials) {
    visit(m.reflectance);
    visit(m.transmittance);
    visit(m.exitance);
    if (m.total_power) visit(*m.total_power);
  }
}
template <class AnySky, class Visit>
void for_each_colour_of_sky(AnySky& sky, const Visit& visit) {
  visit(sky.horizontal_irradiance);
  for (auto& part : sky.parts) for_each_colour_of_sky(part, visit);
}
template <class AnyLights, class Visit>
void for_each_colour_of_lights(AnyLights& lights, const Visit& visit) {
  for (auto& l : lights.luminaires) std::visit([&](auto& kind) { visit(kind.colour()); }, l.kind);
  for (auto& s : lights.suns) visit(s.normal_irradiance);
  if (lights.sky) for_each_colour_of_sky(*lights.sky, visit);
}

const auto kToGrey = [](Spectrum& s) { s = Spectrum(luminous_mean(s)); };

}  // namespace

int Scene::channels() const {
  bool grey = true;
  const auto look_at = [&](const Spectrum& s) { grey = grey && s.is_grey(); };
  for_each_colour_of_materials(materials, look_at);
  for_each_colour_of_lights(lights, look_at);
  if (lights.sky && lights.sky->image) grey = grey && lights.sky->image->is_grey();
  return grey ? 1 : 3;
}

void make_grey(std::vector<Material>& materials) { for_each_colour_of_materials(materials, kToGrey); }

void make_grey(LightSpec& lights) {
  for_each_colour_of_lights(lights, kToGrey);
  if (!lights.sky || !lights.sky->image) return;
  SkyImage image = *lights.sky->image;
  for (std::size_t i = 0; i < image.value.size(); i += 3) {
    const double mean = luminous_mean({image.value[i], image.value[i + 1], image.value[i + 2]});
    for (std::size_t k = i; k < i + 3; ++k) image.value[k] = static_cast<float>(mean);
  }
  lights.sky->image = std::make_shared<const SkyImage>(std::move(image));
}

}  // namespace clerestory
