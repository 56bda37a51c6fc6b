#include "solver/model/scene.h"

#include "solver/model/units.h"

namespace clerestory {
namespace {

/// Calls visit(Spectrum&) for every colour of the scene.
template <class AnyScene, class Visit>
void for_each_colour(AnyScene& scene, const Visit& visit) {
  for (auto& m : scene.materials) {
    visit(m.reflectance);
    visit(m.transmittance);
    visit(m.exitance);
    if (m.total_power) visit(*m.total_power);
  }
  for (auto& l : scene.lights.points) visit(l.power);
  for (auto& l : scene.lights.spots) visit(l.intensity);
  for (auto& l : scene.lights.webs) visit(l.scale);
  for (auto& s : scene.lights.suns) visit(s.normal_irradiance);
  if (scene.lights.sky) visit(scene.lights.sky->horizontal_irradiance);
}

}  // namespace

int Scene::channels() const {
  bool grey = true;
  for_each_colour(*this, [&](const Spectrum& s) { grey = grey && s.is_grey(); });
  if (lights.sky && lights.sky->image) grey = grey && lights.sky->image->is_grey();
  return grey ? 1 : 3;
}

void make_grey(Scene& scene) {
  for_each_colour(scene, [](Spectrum& s) { s = Spectrum(luminous_mean(s)); });
  if (!scene.lights.sky || !scene.lights.sky->image) return;
  SkyImage image = *scene.lights.sky->image;
  for (std::size_t i = 0; i < image.value.size(); i += 3) {
    const double mean = luminous_mean({image.value[i], image.value[i + 1], image.value[i + 2]});
    for (std::size_t k = i; k < i + 3; ++k) image.value[k] = static_cast<float>(mean);
  }
  scene.lights.sky->image = std::make_shared<const SkyImage>(std::move(image));
}

}  // namespace clerestory
