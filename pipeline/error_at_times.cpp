#include "pipeline/error_at_times.h"

#include <algorithm>

#include "pipeline/at_time.h"
#include "solver/lights/layers_of_times.h"

namespace clerestory {
namespace {

std::optional<MeasuredError> if_any(MeasuredError error) {
  return error.samples > 0 ? std::optional(std::move(error)) : std::nullopt;
}

}  // namespace

std::vector<ErrorAtTime> errors_at_times(const SolvedSeries& series, const SensorsOfSeries& sensors,
                                         const ErrorEffort& effort, std::uint64_t seed, const Monitor& monitor) {
  const auto& [problem, mean_map, mean, layers] = series;
  const std::size_t times = problem.lights.times;
  VertexLightmap lightmap = mean_map;
  Solution solution;
  solution.method = mean.method;
  solution.rays = mean.rays / times;
  std::vector<ErrorAtTime> errors(times);
  for (std::size_t t = 0; t < times && !monitor.should_stop(); ++t) {
    const Lights lights = lights_at(problem.lights, t);
    const Problem own{problem.patches, problem.rays, lights};
    lightmap.E = light_of_time(layers.E, t, times, mean.E.channels);
    solution.E = light_of_time(layers.E_elements, t, times, mean.E.channels);
    solution.B = light_of_time(layers.B, t, times, mean.E.channels);
    if (std::ranges::all_of(solution.E.value, [](double E) { return E == 0; })) continue;
    errors[t].surfaces = if_any(measure_error(own, lightmap, solution, effort, seed, monitor));
    if (!sensors.points.empty())
      errors[t].sensors = if_any(measure_sensor_error(own, sensors.points, sensors.sets,
                                                      light_of_time(sensors.layers, t, times, mean.E.channels),
                                                      solution, effort, seed, monitor));
  }
  return errors;
}

}  // namespace clerestory
