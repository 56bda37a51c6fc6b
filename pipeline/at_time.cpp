#include "pipeline/at_time.h"

#include <utility>

#include "solver/illumination/light_rows.h"
#include "solver/model/light_of_times.h"

namespace clerestory {

Field light_of_time(const Field& lanes, std::size_t t, std::size_t times, int channels) {
  Field own = one_layer(lanes, t, channels);
  for (double& value : own.value) value *= static_cast<double>(times);
  return own;
}

Scene scene_at(const Scene& series, std::size_t t) {
  Scene scene;
  scene.file = series.file, scene.files = series.files;
  scene.lights = light_at(series.lights, t);
  scene.daylight = series.times[t].daylight;
  scene.sensors = series.sensors;
  scene.spaces = series.spaces, scene.rooms = series.rooms;
  scene.not_read = series.not_read;
  return scene;
}

Solved solved_at(const Solved& series, std::size_t t) {
  const SolvedLayers& layers = series.layers;
  const std::size_t times = layers.layers.size();
  const int channels = series.patches.channels;
  Solved own;
  own.patches = series.patches;
  own.lightmap = series.lightmap;
  own.lightmap.E = light_of_time(layers.light.E, t, times, channels);
  Solution& solution = own.solution;
  solution.method = series.solution.method;
  solution.E = light_of_time(layers.light.E_elements, t, times, channels);
  solution.B = Field(own.patches.patch_count(), channels);
  for (std::size_t i = 0; i < own.patches.patch_count(); ++i)
    solution.B.set(i, own.patches.M[i] + own.patches.scattered(solution.E, i));
  const EnergyBalance& share = layers.energy[t];
  const auto n = static_cast<double>(times);
  solution.energy = {n * share.emitted, n * share.absorbed, n * share.escaped};
  solution.stop = series.solution.stop, solution.stopped_at = series.solution.stopped_at;
  solution.iterations = series.solution.iterations, solution.residual = series.solution.residual;
  solution.rays = series.solution.rays;
  solution.clusters = series.solution.clusters, solution.links = series.solution.links;
  if (layers.sensor_E.size() > 0) own.sensor_E = light_of_time(layers.sensor_E, t, times, channels);
  own.error = series.error_at[t].surfaces, own.error_sensors = series.error_at[t].sensors;
  own.panes = series.panes;
  own.buried_sensors = series.buried_sensors;
  own.repairs = series.repairs;
  own.lit_sides = series.lit_sides;
  own.openings = series.openings;
  own.settings = series.settings, own.settings.layers = false;
  own.seconds = series.seconds;
  return own;
}

}  // namespace clerestory
