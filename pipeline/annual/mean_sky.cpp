#include "pipeline/annual/mean_sky.h"

#include <memory>
#include <numbers>
#include <numeric>
#include <utility>

namespace clerestory {

Sky mean_sky(std::span<const DaylightHour> hours, std::span<const float> counts, const YearLight& year,
             const SkyParts& coarse) {
  std::vector<double> radiance(coarse.count(), 0.0);
  double all = 0;
  for (std::size_t h = 0; h < hours.size(); ++h) {
    if (!(counts[h] > 0)) continue;
    all += counts[h];
    for (std::size_t k = 0; k < radiance.size(); ++k) radiance[k] += counts[h] * year.coarse.at(k, h);
    if (!hours[h].sun_up) continue;
    const std::size_t part = coarse.part_of(hours[h].sun);
    radiance[part] += counts[h] * hours[h].sun_normal_irradiance * hours[h].sun.z / coarse.on_horizontal(part);
  }
  auto image = std::make_shared<SkyImage>();
  image->width = 120, image->height = 60;
  for (std::size_t row = 0; row < image->height; ++row)
    for (std::size_t column = 0; column < image->width; ++column) {
      const double down = (static_cast<double>(row) + 0.5) / static_cast<double>(image->height) * std::numbers::pi;
      const double turn =
          ((static_cast<double>(column) + 0.5) / static_cast<double>(image->width) - 0.5) * 2 * std::numbers::pi;
      const std::size_t part =
          coarse.part_of({std::sin(down) * std::sin(turn), std::sin(down) * std::cos(turn), std::cos(down)});
      image->value.insert(image->value.end(), 3,
                          part < coarse.count() ? static_cast<float>(radiance[part] / all) : 0.0f);
    }
  Sky sky;
  sky.model = SkyModel::image;
  sky.horizontal_irradiance = horizontal_irradiance(*image);
  sky.ground_reflectance = hours.front().sky.ground_reflectance;
  sky.image = std::move(image);
  return sky;
}

Scene under_sky(const Scene& scene, Sky sky) {
  Scene out = scene;
  out.lights = {};
  out.lights.sky = std::move(sky);
  out.daylight.reset();
  for (Material& material : out.materials) {
    material.exitance = Spectrum(0.0);
    material.total_power.reset();
  }
  return out;
}

}  // namespace clerestory
