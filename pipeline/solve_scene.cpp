#include "pipeline/solve_scene.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/collect_around.h"
#include "pipeline/error_at_times.h"
#include "pipeline/lap.h"
#include "pipeline/panel_hints.h"
#include "pipeline/parts_of_light.h"
#include "pipeline/prepare.h"
#include "pipeline/repeat_to_target.h"
#include "pipeline/require_valid.h"
#include "pipeline/result_checks.h"
#include "pipeline/scene_checks.h"
#include "solver/evaluate/sensor_planes.h"
#include "solver/model/radiosity_at_points.h"
#include "solver/run/accuracy.h"

namespace clerestory {
namespace {

constexpr double kShareToMeasure = 0.1;  ///< of a time limit
/// For an error that is stated after the time limit, too.
constexpr std::chrono::milliseconds kTimeToMeasure{400};

/// By that effort; by four times as much, and again, while that leaves open whether a target is met and took less than
/// a share of the time since `start`. Nothing where there was no time, or no light.
template <class Measure>
std::optional<MeasuredError> measured(ErrorEffort effort, const std::optional<double>& target,
                                      std::chrono::steady_clock::time_point start, const Monitor& monitor,
                                      const Measure& measure) {
  using Clock = std::chrono::steady_clock;
  constexpr double kShare = 0.1;
  const auto leaves_open = [&](const MeasuredError& error) {
    const auto largest = error.largest();
    return target && largest.lower <= *target && *target < largest.upper;
  };
  auto before = Clock::now();
  MeasuredError error = measure(effort);
  while (leaves_open(error) && Clock::now() - before < kShare * (before - start)) {
    before = Clock::now();
    effort.points *= 4, effort.paths *= 4, effort.rays *= 4;
    const MeasuredError sharper = measure(effort);
    if (monitor.should_stop() || sharper.samples < error.samples) break;  // part of it says less than what there is
    error = sharper;
  }
  return error.samples > 0 ? std::optional(error) : std::nullopt;
}

struct PlanesAndE {
  std::vector<SensorPoint> planes;
  std::vector<PointsOfSet> sets;
  Field E;
};

/// All but those with the given numbers, ascending.
PlanesAndE without(const std::vector<std::size_t>& numbers, const SensorPlanes& sensors,
                   const std::vector<SensorSet>& sets, const Field& E) {
  PlanesAndE rest{{}, {}, Field(sensors.planes.size() - numbers.size(), E.channels)};
  auto next = numbers.begin();
  std::size_t sensor = 0, plane = 0;
  for (const SensorSet& set : sets) {
    sensor += set.points.size();
    for (; plane < sensors.begin[sensor]; ++plane) {
      if (next != numbers.end() && *next == plane) {
        ++next;
        continue;
      }
      std::ranges::copy(lanes_of(E, plane), lanes_of(rest.E, rest.planes.size()).begin());
      rest.planes.push_back(sensors.planes[plane]);
    }
    rest.sets.push_back({set.name, rest.planes.size()});
  }
  return rest;
}

/// Radiosity is shown where it tells more than irradiance; that of times is found when they are shown.
void show_layers(LayeredField field, bool are_times, Solved& out) {
  const PatchSet& patches = out.patches;
  SolvedLayers& to = out.layers;
  to.energy = std::move(field.energy);
  const bool glows = !std::ranges::all_of(patches.M.value, [](double M) { return M == 0; });
  if (!are_times && (glows || !patches.tau.value.empty())) {
    to.light.B = Field(field.E.size(), field.E.channels);
    for (std::size_t s = 0; s < to.layers.size(); ++s) {
      const Field B = radiosity_at_points(patches, out.lightmap, one_layer(field.E, s, patches.channels),
                                          exitance(patches, {&to.layers[s], 1}));
      set_layer(B, s, to.light.B);
    }
    to.light.B_elements = std::move(field.B);
  }
  to.light.E = std::move(field.E);
  to.light.E_elements = std::move(field.E_elements);
}

}  // namespace

Solved solve_scene(const Scene& scene, const Settings& asked, Observer& observer) {
  require_valid(scene, asked);
  warn_about_scene(scene, observer);
  require_light(scene);
  const SensorPlanes sensors = planes_of(scene.sensors);

  std::optional<std::vector<std::size_t>> buried;  // once the first patches are there
  bool has_solved = false;
  std::vector<std::string> hints;
  Solved best = repeat_to_target(
      asked, observer, [&](Settings& settings, const Monitor& monitor, StageSeconds& seconds) -> std::optional<Solved> {
        // Scene -> patches, rays, lights, sides that light can reach, points to show it on.
        Solved out;
        const auto start = std::chrono::steady_clock::now();
        Monitor preparing = monitor;  // late or not, there is nothing to show before the first round
        if (has_solved) preparing.interrupted = [&] { return monitor.should_stop(); };
        const bool measures = settings.error_samples.value_or(1) > 0;
        const Monitor solving = measures ? monitor.within((1 - kShareToMeasure) * monitor.seconds_left()) : monitor;
        std::optional<PreparedToSolve> prepared = prepare_to_solve(scene, settings, observer, preparing, seconds);
        if (!prepared) return {};
        auto& [patches, repairs, rays, lights, lit_sides] = prepared->scene;
        const Problem problem = prepared->scene.problem();
        if (!buried) {
          buried = warn_about_places(problem, scene, sensors, settings.solve.method, observer);
          hints = hints_about_panels(problem);
        }

        // -> radiosity of elements, irradiance at vertices.
        Lap lap;
        const SolveOptions& options = settings.solve;
        out.layers.layers = parts_of_light(scene, settings, lights, patches);
        SolvedPatches solved = solve(problem, std::move(prepared->lightmap), repairs.max_element, options, solving,
                                     {.sensors = sensors.planes,
                                      .seconds_before = seconds.mesh + seconds.build,
                                      .layers = out.layers.layers,
                                      .debug = settings.debug ? &out.debug : nullptr});
        if (solved.rather) {
          out.rather = solved.rather;
          lap.add_to(seconds.gather);
          return out;
        }
        Solution& solution = solved.solution;
        out.panes = panes_of(patches);  // before elements take their place, which have none

        if (solved.elements.patch_count() > 0) patches = std::move(solved.elements);  // the problem is about these now
        monitor.report(sensors.planes.empty() ? "error" : "sensors", 0);  // ends the last stage of the solve
        lap.add_to(seconds.gather);

        // -> irradiance at sensors.
        std::optional<RowLight> light_of_layers;
        if (!solved.layers.empty()) light_of_layers.emplace(out.layers.layers, patches.channels, solved.layers.B);
        const PointIrradiance at_planes = irradiance_at_sensors(problem, solution, sensors.planes, options, solving,
                                                                light_of_layers ? &*light_of_layers : nullptr);
        if (at_planes.complete()) {
          out.sensor_E = mean_over_planes(sensors, at_planes.E);
          // The planes of one sensor share no path, but what they have in common may be off alike: not divided by root
          // N.
          if (light_of_layers) out.layers.sensor_E = mean_over_planes(sensors, at_planes.layers);
          if (at_planes.std_error.size() > 0) out.sensor_std_error = mean_over_planes(sensors, at_planes.std_error);
        }
        solution.rays += at_planes.rays;
        if (solving.should_stop() && solution.stop == StopReason::converged) solution.stop = StopReason::time_limit;
        lap.add_to(seconds.reconstruct);

        // -> how wrong both are, as far as there is time: a little after the limit, too.
        ErrorEffort spend = effort(solved.shown, options.tighten).error;
        spend.asked_points = settings.error_samples;
        Monitor measuring = monitor;
        if (monitor.is_late())
          measuring.deadline =
              std::min(std::chrono::steady_clock::now() + kTimeToMeasure, monitor.deadline + 3 * kTimeToMeasure);
        if (measures)
          out.error = measured(spend, settings.target_error, start, measuring, [&](const ErrorEffort& e) {
            return measure_error(problem, solved.lightmap, solution, e, options.seed, measuring);
          });
        if (measures && at_planes.complete()) {
          const auto [planes, sets, E] = without(*buried, sensors, scene.sensors, at_planes.E);
          out.error_sensors = measured(spend, settings.target_error, start, measuring, [&](const ErrorEffort& e) {
            return measure_sensor_error(problem, planes, sets, E, solution, e, options.seed, measuring);
          });
        }
        if (!scene.times.empty()) out.error_at.resize(scene.times.size());
        if (measures && light_of_layers && !scene.times.empty()) {
          ErrorEffort of_time = effort(Accuracy::draft, options.tighten).error;
          of_time.asked_points = settings.error_samples;
          const auto [planes, sets, E] = without(*buried, sensors, scene.sensors, at_planes.layers);
          out.error_at = errors_at_times({problem, solved.lightmap, solution, solved.layers}, {planes, sets, E},
                                         of_time, options.seed, measuring);
        }
        out.buried_sensors = sensors_of(sensors, *buried).size();
        if (monitor.is_interrupted()) solution.stop = StopReason::interrupted;
        lap.add_to(seconds.measure);

        out.openings = lights.sky_openings().size();
        out.patches = std::move(patches);
        out.laws = std::move(solved.laws);
        out.lightmap = std::move(solved.lightmap);
        if (light_of_layers) show_layers(std::move(solved.layers), !scene.times.empty(), out);
        out.solution = std::move(solution);
        out.repairs = repairs;
        out.lit_sides = std::move(lit_sides);
        has_solved = true;
        return out;
      });
  warn_about_result(best, observer);
  for (const std::string& hint : hints) observer.warn(scene.file + ": " + hint);  // last, where it is seen
  return best;
}

Solved solve_scene(const Scene& scene, const Settings& settings) {
  Observer nobody;
  return solve_scene(scene, settings, nobody);
}

}  // namespace clerestory
