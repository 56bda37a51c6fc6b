#include "solver/model/light_of_times.h"

#include <algorithm>

#include "solver/model/assert.h"

namespace clerestory {
namespace {

/// Skies of one scene at different times: what else they are is the same.
bool are_alike(const Sky& a, const Sky& b) {
  if (a.model == SkyModel::image) return true;
  return a.model == b.model && !a.shape.needs_sun() && a.horizontal_irradiance == b.horizontal_irradiance;
}

Sky mean_of(std::span<const LightSpec> times) {
  Sky mean = *times[0].sky;
  if (std::ranges::all_of(times, [&](const LightSpec& t) { return are_alike(mean, *t.sky); })) return mean;
  mean = {
      .model = SkyModel::mean, .horizontal_irradiance = Spectrum(0.0), .ground_reflectance = mean.ground_reflectance};
  for (const LightSpec& time : times) {
    mean.parts.push_back(*time.sky);
    mean.horizontal_irradiance += time.sky->horizontal_irradiance / static_cast<double>(times.size());
  }
  return mean;
}

}  // namespace

LightSpec mean_over_times(LightSpec always, std::span<const LightSpec> times) {
  CLERESTORY_ASSERT(times.size(), >, 0u);
  always.times = times.size();
  if (times[0].sky) always.sky = mean_of(times);
  for (std::size_t t = 0; t < times.size(); ++t)
    for (const Sun& sun : times[t].suns)
      always.suns.push_back({sun.direction, sun.normal_irradiance / static_cast<double>(times.size()), t});
  return always;
}

std::optional<Sky> sky_at(const std::optional<Sky>& mean, std::size_t t) {
  return mean && mean->model == SkyModel::mean ? mean->parts.at(t) : mean;
}

LightSpec light_at(const LightSpec& mean, std::size_t t) {
  return {mean.luminaires, sky_at(mean.sky, t), suns_at(mean.suns, mean.times, t)};
}

}  // namespace clerestory
