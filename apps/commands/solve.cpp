// clerestory solve: the main job, from a model and its light to a picture of where the light goes.

#include <chrono>
#include <limits>
#include <new>

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/run.h"
#include "apps/scene_checks.h"
#include "apps/settings.h"
#include "apps/solve_report.h"
#include "apps/wording.h"
#include "io/atomic_file.h"
#include "io/read_sensors.h"
#include "io/write_debug.h"
#include "io/write_result.h"
#include "io/write_sensors.h"
#include "meshing/make_lightmap.h"
#include "solver/gather.h"
#include "solver/memory_estimate.h"
#include "solver/model/error.h"
#include "solver/model/units.h"
#include "solver/solve_hierarchical.h"

namespace clerestory {
namespace {

struct Arguments {
  CommonArguments common;
  SolveArguments solve;
  ReadOptions read;
  std::string input, output, sensors, sensors_output;
};

std::filesystem::path sensors_output(const Arguments& arguments) {
  if (!arguments.sensors_output.empty()) return arguments.sensors_output;
  return std::filesystem::path(arguments.output).replace_extension(".sensors.csv");
}

using Clock = std::chrono::steady_clock;

/// Adds the seconds since it was made, or since the last call, to `sum`.
class Lap {
 public:
  void add_to(double& sum) {
    const auto now = Clock::now();
    sum += std::chrono::duration<double>(now - begin_).count();
    begin_ = now;
  }

 private:
  Clock::time_point begin_ = Clock::now();
};

std::optional<MeasuredError> if_measured(const MeasuredError& error) {
  return error.samples > 0 ? std::optional(error) : std::nullopt;
}

/// Every plane of a sensor gets its value, however little time there is: a rough one when the good ones take too long.
PointIrradiance gather_all_planes(const Problem& problem, const Solution& solution, std::span<const SensorPoint> planes,
                                  SolveOptions options, const Monitor& monitor) {
  PointIrradiance at_planes = gather_at_sensors(problem, solution, planes, options, monitor);
  if (at_planes.complete) return at_planes;
  options.accuracy = Accuracy::draft;
  return gather_at_sensors(problem, solution, planes, options, {.progress = monitor.progress});
}

/// Memory that a limit leaves for the solve, when the model has been read.
std::size_t memory_after_reading(std::size_t limit, const MeshReport& repairs) {
  const std::size_t reading = predicted_memory({repairs.input_triangles}) - predicted_memory({});
  return limit > reading ? limit - reading : 1;
}

[[noreturn]] void refuse_memory(const Scene& scene, std::size_t needed, std::size_t limit) {
  throw InputError(scene.file + ": needs about " + bytes(needed) + ", more than the memory limit of " + bytes(limit) +
                   "; raise --memory-limit, or leave out detail of the model.");
}

/// What is solved.
struct Prepared {
  PatchSet patches;
  MeshReport repairs;
  Lights lights;
  LitSides lit_sides;
  VertexLightmap map;
};

/// surfaces -> patches -> rays -> sides that light can reach -> points. Nothing after Ctrl-C.
std::optional<Prepared> prepare(const Scene& scene, const Settings& settings, std::optional<RayScene>& rays,
                                RunReport::Seconds& seconds, const Monitor& monitor) {
  Lap lap;
  MeshedScene meshed = build_patches(scene, settings.mesh, monitor);
  Prepared p{std::move(meshed.patches), meshed.report, {}, {}, {}};
  p.patches.channels = settings.channels;
  lap.add_to(seconds.mesh);
  if (monitor.is_interrupted()) return {};

  rays.emplace(p.patches);
  p.lights = local_lights(scene.lights, p.patches, *rays);
  p.lit_sides = find_lit_sides({p.patches, *rays, p.lights}, settings.solve.seed, monitor);
  make_patches(p.patches, p.lit_sides.wanted);
  if (p.patches.patch_count() == 0)
    throw InputError(scene.file + ": no light reaches any surface; move or aim the lights at the model.");
  p.map = make_lightmap(p.patches);
  lap.add_to(seconds.build);
  return p;
}

/// The same within the memory limit: with larger elements, and again, until they fit. `settings` end as they are in
/// force.
std::optional<Prepared> prepare_to_fit(const Scene& scene, Settings& settings, std::optional<RayScene>& rays,
                                       RunReport::Seconds& seconds, Console& console, const Monitor& monitor) {
  if (!settings.memory_limit) return prepare(scene, settings, rays, seconds, monitor);
  const std::size_t limit = *settings.memory_limit, faces = scene.polygons.face_count();
  const double asked = settings.mesh.max_element.value_or(0), wanted = settings.mesh.target_triangles;
  std::size_t fit = triangles_that_fit(faces, limit);
  if (fit == 0) refuse_memory(scene, least_memory({faces, faces, faces, faces, faces}), limit);
  for (std::size_t last = std::numeric_limits<std::size_t>::max();; fit /= 2) {
    settings.mesh.fit_triangles = static_cast<double>(fit);
    std::optional<Prepared> p = prepare(scene, settings, rays, seconds, monitor);
    if (!p) return {};
    settings.solve.memory_limit = memory_after_reading(limit, p->repairs);
    if (has_memory_for(p->patches, p->map, settings.solve)) {
      const bool coarser = asked > 0 ? p->repairs.max_element > 1.01 * asked : static_cast<double>(fit) < wanted;
      if (coarser)
        console.warn("coarser than asked for, to stay below the memory limit of " + bytes(limit) +
                     ": elements of up to " + rounded(p->repairs.max_element) + " m" +
                     (asked > 0 ? " instead of " + rounded(asked) + " m." : "."));
      return p;
    }
    const std::size_t triangles = p->repairs.triangles, sides = p->patches.patch_count();
    if (triangles > last / 10 * 9)
      refuse_memory(scene, least_memory({p->repairs.input_triangles, triangles, sides, sides, p->map.position.size()}),
                    limit);
    last = triangles;
  }
}

/// The data flow of the README: surfaces -> patches -> solution -> field on vertices and at sensors -> its error.
/// Nothing when Ctrl-C came before there were patches to solve.
std::optional<Solved> solve_scene(const Scene& scene, Settings settings, const SensorPlanes& sensors,
                                  RunReport::Seconds& seconds, Console& console, const Monitor& monitor) {
  std::optional<RayScene> rays;
  std::optional<Prepared> prepared = prepare_to_fit(scene, settings, rays, seconds, console, monitor);
  if (!prepared) return {};
  auto& [patches, repairs, lights, lit_sides, lightmap] = *prepared;
  const Problem problem{patches, *rays, lights};
  warn_about_places(problem, scene, sensors, console);

  Lap lap;
  Solution solution;
  HierarchyDebug debug;
  if (settings.solve.method == Method::hierarchical) {
    ShownSolution shown = solve_hierarchical(problem, std::move(lightmap), repairs.max_element, settings.solve, monitor,
                                             settings.debug ? &debug : nullptr);
    solution = std::move(shown.solution);
    lightmap = std::move(shown.lightmap);
    patches = std::move(shown.elements);  // rays know which part of a triangle is which element
  } else {
    solution = solve(problem, settings.solve, monitor);
    average_to_points(patches, solution.E, lightmap);
    if (settings.solve.accuracy != Accuracy::draft && !monitor.should_stop())
      solution.rays += gather_at_points(problem, solution, lightmap, settings.solve, monitor);
  }
  lap.add_to(seconds.gather);

  const PointIrradiance at_planes = gather_all_planes(problem, solution, sensors.planes, settings.solve, monitor);
  solution.rays += at_planes.rays;
  if (monitor.should_stop() && solution.stop == StopReason::converged) solution.stop = StopReason::time_limit;
  lap.add_to(seconds.reconstruct);

  std::optional<MeasuredError> error, error_sensors;
  if (!monitor.should_stop())
    error = if_measured(measure_error(problem, lightmap, settings.solve, solution.rays, monitor));
  if (!monitor.should_stop() && !sensors.planes.empty())
    error_sensors =
        if_measured(measure_sensor_error(problem, sensors.planes, at_planes.E, settings.solve, solution.rays, monitor));
  if (monitor.is_interrupted()) solution.stop = StopReason::interrupted;
  lap.add_to(seconds.measure);
  return Solved{std::move(patches),
                repairs,
                std::move(lit_sides),
                std::move(solution),
                std::move(lightmap),
                mean_over_planes(sensors, at_planes.E),
                error,
                error_sensors,
                std::move(debug)};
}

/// Met for sure: the measured error and what is uncertain about it.
bool meets(const Solved& solved, double target) {
  return solved.error && solved.error->rms_relative + solved.error->confidence <= target;
}

/// Solves once, or as often as the target error asks for; settings end as they were for the result returned, the best.
std::optional<Solved> solve_to_target(const Scene& scene, Settings& settings, const SensorPlanes& sensors,
                                      RunReport::Seconds& seconds, Console& console, const Monitor& monitor) {
  constexpr int kRounds = 5;  // the last has 16 times the elements of the first
  std::optional<Solved> best = solve_scene(scene, settings, sensors, seconds, console, monitor);
  if (!best || !settings.target_error) return best;
  const double target = *settings.target_error;
  Settings finer = settings;
  for (int round = 1; round < kRounds && !meets(*best, target) && !monitor.should_stop(); ++round) {
    finer.tighten(finer.mesh.max_element.value_or(best->repairs.max_element));
    console.note("error " + percent(best->error ? best->error->rms_relative : 1) + ", asked for " + percent(target) +
                 ": again with elements of " + rounded(*finer.mesh.max_element) + " m and twice the rays");
    // What is solved already must not be lost to a try that needs too much.
    try {
      std::optional<Solved> next = solve_scene(scene, finer, sensors, seconds, console, monitor);
      if (!next || !next->error || (best->error && next->error->rms_relative > best->error->rms_relative)) continue;
      best = std::move(next);
      settings = finer;
    } catch (const InputError& e) {
      console.warn(std::string("the target error would need more than this: ") + e.what());
      break;
    } catch (const std::bad_alloc&) {
      console.warn("the target error would need more memory than there is.");
      break;
    }
  }
  if (monitor.should_stop() && !meets(*best, target)) best->solution.stop = why_stopped(monitor);
  return best;
}

ExitCode exit_code(const Solved& solved, const Settings& settings) {
  if (solved.solution.stop == StopReason::interrupted) return kInterrupted;
  if (solved.solution.stop != StopReason::converged) return kAccuracyNotReached;
  if (settings.target_error && !meets(solved, *settings.target_error)) return kAccuracyNotReached;
  return kDone;
}

void say_why(ExitCode code, const Solved& solved, const Settings& settings, Console& console) {
  if (code == kInterrupted) console.warn("interrupted; what was solved so far is written.");
  if (code != kAccuracyNotReached) return;
  if (solved.solution.stop == StopReason::time_limit)
    console.warn("the time limit of " + rounded(settings.time_limit.value_or(0)) +
                 " s came before the end; the result so far is written" +
                 (solved.solution.shown.empty() ? "" : ": " + solved.solution.shown) + ".");
  else if (solved.solution.stop == StopReason::iteration_limit)
    console.warn("the method stopped before it converged, at a residual of " + percent(solved.solution.residual) +
                 "; the result so far is written.");
  else
    console.warn("the target error of " + percent(*settings.target_error) + " was not reached" +
                 (solved.error ? ", only " + percent(solved.error->rms_relative) : "") + "; the result is written.");
}

ExitCode solve_command(const Arguments& arguments, Console& console) {
  const auto start = Clock::now();
  check_writable(arguments.output);
  RunReport report = new_report(arguments.input);

  Lap lap;
  Scene scene = read_scene(arguments.input, arguments.read);
  if (!arguments.sensors.empty()) scene.sensors = {read_sensors(arguments.sensors)};
  Settings settings = effective_settings(arguments.common, arguments.solve, scene);
  if (settings.channels == 1) make_grey(scene);
  if (settings.debug) {
    if (settings.solve.method != Method::hierarchical) {
      console.fail("--debug-output shows the hierarchical method only, and the method is " +
                   std::string(kMethodNames[static_cast<std::size_t>(settings.solve.method)]) + ".");
      return kWrongUsage;
    }
    check_debug_folder(arguments.solve.debug_output);
  }
  warn_about_scene(scene, console);
  require_light(scene);
  const SensorPlanes sensors = planes_of(scene.sensors);
  const std::filesystem::path sensors_file = sensors_output(arguments);
  const bool has_sensors = sensors.sensor_count() > 0;
  if (has_sensors) check_writable(sensors_file);
  if (!has_sensors && !arguments.sensors_output.empty())
    throw InputError("--sensors-out " + arguments.sensors_output +
                     ": there are no sensors to write; give --sensors POINTS.csv, or \"sensors\" in the scene file.");
  lap.add_to(report.seconds.read);

  const auto deadline =
      settings.time_limit
          ? start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(*settings.time_limit))
          : Clock::time_point::max();
  const std::optional<Solved> result =
      solve_to_target(scene, settings, sensors, report.seconds, console, console.monitor(deadline));
  if (!result) {
    console.warn("interrupted before anything was solved; nothing is written.");
    return kInterrupted;
  }
  const Solved& solved = *result;
  split_by_stage(report.seconds, console);
  for (const std::string& line : solved.solution.log) console.note(line);

  Lap writing;
  report.settings = as_figures(settings, arguments.read);
  report.threads = arguments.common.threads;
  fill_report(report, scene, solved);
  write_result(arguments.output, solved.patches, solved.lightmap, solved.solution, daylight_reference(scene.lights),
               report);
  if (has_sensors) write_sensors(sensors_file, all_sensor_points(scene), solved.sensor_E);
  if (settings.debug) write_debug(arguments.solve.debug_output, solved.debug, solved.patches.origin);
  writing.add_to(report.seconds.write);

  const ExitCode code = exit_code(solved, settings);
  say_why(code, solved, settings, console);
  report.seconds.total = console.elapsed();
  report.peak_memory_bytes = peak_memory_bytes();
  report.warnings = console.warnings();
  if (!arguments.common.report.empty()) write_report(arguments.common.report, report);
  say_summary(report, solved, console);
  console.say("  results " + arguments.output + (has_sensors ? ", " + sensors_file.string() : "") +
              (arguments.common.report.empty() ? "" : ", " + arguments.common.report));
  return code;
}

}  // namespace

void add_solve_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *program.add_subcommand("solve", "read, mesh, solve, write: the main job");
  add_input_options(command, arguments->input, arguments->read);
  command.add_option("-o,--output", arguments->output, "the result, for ParaView")->type_name("OUT.vtp")->required();
  require_extension(command, "--output", ".vtp");
  SolveArguments& s = arguments->solve;
  add_checked_word(
      command, "--method", s.method, problem_with_method,
      "hierarchical, progressive, gauss-seidel, jacobi, or path, the unbiased reference (default: hierarchical)");
  add_checked_word(command, "--accuracy", s.accuracy, problem_with_accuracy,
                   "draft, standard or fine (default: standard)");
  add_positive_option(command, "--target-error", s.target_error, "SHARE",
                      "go on until the measured RMS relative error is below this, 0.02 for 2 %");
  add_positive_option(command, "--time-limit", s.time_limit, "S", "stop solving after so many seconds");
  add_checked_word(command, "--memory-limit", s.memory_limit, problem_with_memory,
                   "coarser rather than more memory than this: 500MiB, 2GiB, or a number of MiB (default: none)")
      ->type_name("SIZE");
  add_positive_option(command, "--max-element", s.max_element, "M",
                      "longest element edge in metres (default: by accuracy and size)");
  command.add_option("--sensors", arguments->sensors, "points to report on, x,y,z,nx,ny,nz in metres")
      ->type_name("POINTS.csv");
  command.add_option("--sensors-out", arguments->sensors_output, "where to (default: OUT.sensors.csv)")
      ->type_name("OUT.csv");
  command
      .add_option("--debug-output", s.debug_output,
                  "also show the hierarchy: hierarchy.vtp, links.vtp, rays.vtp and error.vtp, written there")
      ->type_name("DIR");
  add_choice(command, "--channels", s.channels, {"1", "3"}, "1 = grey, 3 = colour (default: what the scene needs)");
  command.add_flag("--grey", s.grey, "solve in one channel, the same as --channels 1")->excludes("--channels");
  add_common_options(command, arguments->common);
  command.footer("example: clerestory solve data/scenes/office.json -o office.vtp --accuracy fine");
  command.callback([arguments, &task] {
    task = [arguments] {
      std::vector<NamedFile> files = {{"--sensors", arguments->sensors, false},
                                      {"-o", arguments->output},
                                      {"--sensors-out", sensors_output(*arguments).string()}};
      if (!arguments->solve.debug_output.empty())
        for (const auto& file : debug_files(arguments->solve.debug_output))
          files.push_back({"--debug-output", file.string()});
      return run(arguments->common, arguments->input, std::move(files),
                 [&](Console& console) { return solve_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
