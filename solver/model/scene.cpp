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
  for (auto& s : scene.lights.suns) visit(s.normal_irradiance);
  if (scene.lights.sky) visit(scene.lights.sky->horizontal_irradiance);
}

}  // namespace

int Scene::channels() const {
  bool grey = true;
  for_each_colour(*this, [&](const Spectrum& s) { grey = grey && s.is_grey(); });
  return grey ? 1 : 3;
}

void make_grey(Scene& scene) {
  for_each_colour(scene, [](Spectrum& s) { s = Spectrum(luminous_mean(s)); });
}

}  // namespace clerestory
