#include "pipeline/collect_around.h"

#include <span>

#include "solver/lights/luminaire.h"
#include "solver/lights/sky.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

SkyTable table_of(const SkyRadiance& sky, int channels) {
  SkyTable table;
  if (sky.dark()) return table;
  table.radiance = Field(SkyTable::kRows * SkyTable::kColumns, channels);
  for (std::size_t i = 0; i < table.radiance.size(); ++i) {
    const Spectrum L = sky(SkyTable::direction(i / SkyTable::kColumns, i % SkyTable::kColumns));
    table.radiance.set(i, channels == 1 ? Spectrum(luminous_mean(L)) : L);
  }
  return table;
}

SkyTable sky_table(const LightSpec& spec, int channels) {
  Lights lights;
  lights.sky = spec.sky;
  for (const Sun& sun : spec.suns) lights.suns.push_back({sun});
  return table_of(SkyRadiance(lights), channels);
}

std::vector<MeasuredSensors> measured_sensors(const std::vector<SensorSet>& sets, const Field& E, const Field& layers) {
  std::vector<MeasuredSensors> measured;
  if (E.size() == 0) return measured;
  std::size_t next = 0;
  for (const SensorSet& set : sets) {
    MeasuredSensors& m = measured.emplace_back(MeasuredSensors{set, {}});
    if (!layers.value.empty()) {
      const auto lanes = static_cast<std::size_t>(layers.channels);
      const auto rows = std::span(layers.value).subspan(next * lanes, set.points.size() * lanes);
      m.layers.channels = layers.channels;
      m.layers.value.assign(rows.begin(), rows.end());
    }
    for (std::size_t i = 0; i < set.points.size(); ++i) m.illuminance.push_back(photometric(E[next++]));
  }
  return measured;
}

std::vector<ShownLuminaire> shown_luminaires(const std::vector<Luminaire>& luminaires) {
  std::vector<ShownLuminaire> shown;
  for (const Luminaire& l : luminaires) shown.push_back({l.position, l.name, l.group, photometric(power(l))});
  return shown;
}

}  // namespace

std::optional<double> daylight_reference(const LightSpec& lights) {
  if (!lights.sky || !lights.suns.empty()) return {};
  const double reference = photometric(lights.sky->horizontal_irradiance);
  return reference > 0 ? std::optional(reference) : std::nullopt;
}

std::vector<PaneTriangle> panes_of(const PatchSet& patches) {
  std::vector<PaneTriangle> panes;
  for (std::size_t i = 0; i < patches.triangle_count(); ++i) {
    const TriangleId t{i};
    const Material& material = patches.front_material(t);
    if (!material.lets_rays_pass() && !material.turns_rays()) continue;
    PaneTriangle& pane = panes.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) pane.corners[k] = patches.vertices[patches.corners[t][k]] + patches.origin;
    pane.material = static_cast<std::uint32_t>(patches.side_material[t][kFront].value);
    pane.surface = static_cast<std::uint32_t>(patches.side_surface[t][kFront].value);
  }
  return panes;
}

std::vector<ShownLayer> shown_layers(const Solved& solved) {
  const auto& [layers, light, sensor_E, energy] = solved.layers;
  std::vector<ShownLayer> shown;
  if (light.empty()) return shown;
  for (std::size_t s = 0; s < layers.size(); ++s) {
    shown.push_back({layers[s].name, energy[s]});
    if (layers[s].sky) shown.back().sky = table_of(*layers[s].sky, solved.patches.channels);
  }
  return shown;
}

SceneAround collect_around(const Scene& scene, const Solved& solved) {
  return {daylight_reference(scene.lights),
          solved.panes,
          sky_table(scene.lights, solved.patches.channels),
          measured_sensors(scene.sensors, solved.sensor_E, solved.layers.sensor_E),
          shown_luminaires(scene.lights.luminaires),
          shown_layers(solved),
          {scene.files.begin(), scene.files.end()}};
}

}  // namespace clerestory
