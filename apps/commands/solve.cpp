// clerestory solve: the main job, from a model and its light to a picture of where the light goes.

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/effective_settings.h"
#include "apps/finish_report.h"
#include "apps/interrupt.h"
#include "apps/run.h"
#include "apps/series_report.h"
#include "apps/solve_report.h"
#include "io/atomic_file.h"
#include "io/moment.h"
#include "io/read_sensors.h"
#include "io/write_debug.h"
#include "io/write_result.h"
#include "io/write_sensors.h"
#include "io/write_series.h"
#include "pipeline/at_time.h"
#include "pipeline/collect_around.h"
#include "pipeline/lap.h"
#include "pipeline/solve_scene.h"
#include "pipeline/wording.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

struct Arguments {
  CommonArguments common;
  SolveArguments solve;
  ReadOptions read;
  std::string input, output, times, sensors, sensors_output;
};

std::filesystem::path sensors_output(const Arguments& arguments) {
  if (!arguments.sensors_output.empty()) return arguments.sensors_output;
  return std::filesystem::path(arguments.output).replace_extension(".sensors.csv");
}

/// The result of one time of a series, beside it: day.2026-03-21T0600.vtp for day.pvd.
std::filesystem::path file_at(const Arguments& arguments, const Moment& moment) {
  std::string time = moment_text(moment);
  std::erase(time, ':');
  return std::filesystem::path(arguments.output).replace_extension("." + time + ".vtp");
}

/// Of the series asked for; none where it cannot be read, which is said when it is needed.
std::vector<std::filesystem::path> files_of_times(const Arguments& arguments) {
  std::vector<std::filesystem::path> files;
  try {
    if (!arguments.times.empty())
      for (const Moment& moment : read_times(arguments.times, "--times")) files.push_back(file_at(arguments, moment));
  } catch (const InputError&) {
  }
  return files;
}

bool lacks_layers(const Solved& solved) {
  return (solved.settings.layers || !solved.layers.layers.empty()) && solved.layers.light.empty();
}

ExitCode exit_code(const Solved& solved) {
  if (solved.solution.stop == StopReason::interrupted) return kInterrupted;
  const bool as_asked = solved.solution.stop == StopReason::converged && meets_target(solved) && keeps_laws(solved) &&
                        !lacks_layers(solved);
  return as_asked ? kDone : kAccuracyNotReached;
}

void say_why(ExitCode code, const Solved& solved, Console& console) {
  if (code == kInterrupted) console.warn("interrupted; what was solved so far is written.");
  if (code != kAccuracyNotReached) return;
  const Settings& settings = solved.settings;
  if (solved.solution.stop == StopReason::time_limit)
    console.warn("the time limit of " + rounded(settings.time_limit.value_or(0)) +
                 " s came before the end; the result so far is written" +
                 (solved.solution.stopped_at.empty() ? "" : ": " + solved.solution.stopped_at) + ".");
  else if (solved.solution.stop == StopReason::iteration_limit)
    console.warn("the method stopped before it converged, at a residual of " + percent(solved.solution.residual) +
                 "; the result so far is written.");
  else if (!meets_target(solved) && !keeps_its_light(solved))
    console.warn("the target error of " + percent(*settings.target_error) +
                 " was not reached: light is missing or too much" +
                 (solved.error ? ", and the error is " + error_line(*solved.error) : "") + "; the result is written.");
  else if (!meets_target(solved))
    console.warn("the target error of " + percent(*settings.target_error) + " was not reached for sure" +
                 (solved.error ? ": it is " + error_line(*solved.error) : "") + "; the result is written.");
}

/// What a time limit may go over before there is a result: some of that is worth more than none.
constexpr double kGrace = 1.5;

void end_without_result_after(const std::optional<double>& time_limit, const Console& console) {
  constexpr double kNeverSeconds = 1e8;
  if (time_limit && *time_limit < kNeverSeconds)
    end_without_result_at(console.start() +
                          std::chrono::microseconds(static_cast<long long>(1e6 * (*time_limit + kGrace))));
}

/// All that can be refused is refused before the long computation.
void check_outputs(const Arguments& arguments, bool has_sensors) {
  if (!arguments.solve.debug_output.empty()) check_debug_folder(arguments.solve.debug_output);
  if (has_sensors) check_writable(sensors_output(arguments));
  if (!has_sensors && !arguments.sensors_output.empty())
    throw InputError("--sensors-out " + arguments.sensors_output +
                     ": there are no sensors to write; give --sensors POINTS.csv, or \"sensors\" in the scene file.");
}

SensorLayers sensor_layers(const RunReport& report, const Solved& solved) {
  SensorLayers layers;
  if (solved.layers.sensor_E.value.empty()) return layers;
  for (const ShownLayer& layer : report.layers) layers.names.push_back(layer.name);
  layers.E = solved.layers.sensor_E;
  return layers;
}

/// A result a time, with its own report, and the series that names them; `report` learns of each.
void write_times(const Arguments& arguments, const Scene& scene, const Solved& solved, RunReport& report,
                 Outputs& outputs) {
  std::vector<FileOfTime> files;
  SensorLayers sensors;
  sensors.E = solved.layers.sensor_E;
  for (double& value : sensors.E.value) value *= static_cast<double>(scene.times.size());
  for (std::size_t t = 0; t < scene.times.size(); ++t) {
    const Moment& moment = scene.times[t].moment;
    const std::filesystem::path file = file_at(arguments, moment);
    const Scene scene_then = scene_at(scene, t);
    const Solved solved_then = solved_at(solved, t);
    RunReport of_time = new_report(report.input);
    of_time.time = moment_text(moment);
    fill_report(of_time, scene_then, solved_then);
    of_time.settings = report.settings;
    of_time.warnings = report.warnings;
    write_result(outputs.open(file), solved_then.patches, solved_then.lightmap, solved_then.solution,
                 collect_around(scene_then, solved_then), of_time);
    report.times.push_back(figures_at_time(of_time, solved_then, file.filename().string()));
    files.push_back({hours_since(scene.times.front().moment, moment), file.filename().string()});
    sensors.names.push_back(of_time.time);
  }
  write_series(outputs.open(arguments.output), files);
  if (solved.sensor_E.size() > 0)
    write_sensors(outputs.open(sensors_output(arguments)), all_sensor_points(scene.sensors), solved.sensor_E, {},
                  sensors);
}

void write_outputs(const Arguments& arguments, const Scene& scene, const Solved& solved, RunReport& report,
                   Outputs& outputs) {
  if (solved.settings.debug) write_debug(outputs, arguments.solve.debug_output, solved.debug, solved.patches.origin);
  if (!scene.times.empty()) return write_times(arguments, scene, solved, report, outputs);
  write_result(outputs.open(arguments.output), solved.patches, solved.lightmap, solved.solution,
               collect_around(scene, solved), report, solved.layers.light);
  if (solved.sensor_E.size() > 0)
    write_sensors(outputs.open(sensors_output(arguments)), all_sensor_points(scene.sensors), solved.sensor_E,
                  solved.sensor_std_error, sensor_layers(report, solved));
}

/// What was asked for that only one method can; empty: nothing.
std::string of_hierarchical_only(const Arguments& arguments, const Settings& settings) {
  if (settings.debug) return "--debug-output shows";
  if (settings.layers) return "--layers is of";
  if (!arguments.times.empty()) return "--times is of";
  if (settings.solve.oracle == Oracle::bf) return "--oracle bf is of";
  return {};
}

ExitCode solve_command(const Arguments& arguments, Console& console) {
  if (const bool is_series = std::filesystem::path(arguments.output).extension() == ".pvd";
      is_series == arguments.times.empty()) {
    console.fail(is_series
                     ? "-o " + arguments.output + ": a .pvd is a series of results; give --times, or write a .vtp."
                     : "-o " + arguments.output +
                           ": with --times there are several results, and a .pvd names "
                           "them; write one that ends in .pvd.");
    return kWrongUsage;
  }
  Lap lap;
  check_writable(arguments.output);
  RunReport report = new_report(arguments.input);

  end_without_result_after(arguments.solve.time_limit, console);
  ReadOptions read_options = arguments.read;
  if (!arguments.times.empty()) {
    constexpr std::size_t kBeside = 8;  // the series, sensors, the report, what --debug-output shows
    read_options.times = read_times(arguments.times, "--times");
    require_open_files(read_options.times.size() + kBeside, "--times");
  }
  Scene scene = read_scene(arguments.input, read_options);
  if (!arguments.sensors.empty()) scene.sensors = {read_sensors(arguments.sensors)};
  console.has_read(scene.files);
  Settings settings = effective_settings(arguments.common, arguments.solve, scene);
  end_without_result_after(settings.time_limit, console);
  settings.start = console.start();
  if (const std::string option = of_hierarchical_only(arguments, settings);
      !option.empty() && settings.solve.method != Method::hierarchical) {
    console.fail(option + " the hierarchical method only, and the method is " +
                 std::string(kMethodNames[static_cast<std::size_t>(settings.solve.method)]) + ".");
    return kWrongUsage;
  }
  const bool has_sensors = !all_sensor_points(scene.sensors).empty();
  check_outputs(arguments, has_sensors);
  double read = 0, write = 0;
  lap.add_to(read);

  const Solved solved = solve_scene(scene, settings, console);
  if (solved.empty()) {
    console.warn("interrupted before anything was solved; nothing is written.");
    return kInterrupted;
  }
  for (const std::string& line : solved.solution.log) console.note(line);

  Lap writing;
  fill_report(report, scene, solved);
  report.settings = as_figures(solved.settings, solved.patches.channels, arguments.read);
  if (!scene.times.empty()) report.settings.push_back({"times", arguments.times}), report.layers.clear();
  const ExitCode code = exit_code(solved);
  say_why(code, solved, console);
  if (has_sensors && solved.sensor_E.size() == 0)
    console.warn("there was no time for the sensors; " + sensors_output(arguments).string() + " is not written.");
  if (lacks_layers(solved) && !scene.times.empty()) {
    console.warn("stopped before the light was parted among the times; nothing is written.");
    return code;
  }
  if (lacks_layers(solved)) console.warn("there was no time for the layers; the result holds all light together only.");
  report.warnings = console.warnings();  // the result holds them, too
  Outputs outputs;
  write_outputs(arguments, scene, solved, report, outputs);
  writing.add_to(write);
  report.seconds.read = read, report.seconds.write = write;
  finish_report(report, arguments.common, console, outputs);
  say_summary(report, solved, console);
  if (!scene.times.empty()) {
    console.say("  times   " + series_in_words(scene.times) + "; what is above is of their mean light");
    for (const std::string& line : time_table(report.times)) console.say("  " + line);
  }
  console.commit(outputs);
  console.say("  results " + arguments.output +
              (solved.sensor_E.size() > 0 ? ", " + sensors_output(arguments).string() : "") +
              (arguments.common.report.empty() ? "" : ", " + arguments.common.report));
  return code;
}

}  // namespace

void add_solve_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *program.add_subcommand("solve", "read, mesh, solve, write: the main job");
  add_input_options(command, arguments->input, arguments->read);
  command.add_option("-o,--output", arguments->output, "the result, for ParaView; .pvd with --times")
      ->type_name("OUT.vtp")
      ->required();
  require_extension(command, "--output", {".vtp", ".pvd"});
  SolveArguments& s = arguments->solve;
  add_checked_word(command, "--method", s.method, problem_with_method,
                   "hierarchical, progressive, gauss-seidel, jacobi, particles, path, the unbiased reference, or "
                   "bidirectional, the same by paths from both ends (default: hierarchical)");
  add_checked_word(command, "--accuracy", s.accuracy, problem_with_accuracy,
                   "draft, standard or fine (default: standard)");
  add_checked_word(command, "--oracle", s.oracle, problem_with_oracle,
                   "by what the hierarchical method refines: error, or bf, the classic flux at stake (default: error)");
  add_positive_option(
      command, "--target-error", s.target_error, "SHARE",
      "from a draft on as finely as the measured RMS relative error, also of the worst room, needs; 0.02 for 2 %");
  command.add_flag("--no-error", s.no_error, "do not measure the error of the result")->excludes("--target-error");
  command
      .add_option(
          "--error-samples", s.error_samples,
          "points that the error is measured at, up to 4096 (default: by accuracy and rooms, 4 to 14 % of the time)")
      ->type_name("N")
      ->check(CLI::Range(8, 4096))
      ->excludes("--no-error");
  command.add_flag("--check", s.check,
                   "check the result against the laws of radiosity, room by room; exit code 4 when one is broken");
  add_positive_option(command, "--time-limit", s.time_limit, "S",
                      "the best result of so many seconds, up to the accuracy asked for");
  add_checked_word(command, "--memory-limit", s.memory_limit, problem_with_memory,
                   "coarser rather than more memory than this: 500MiB, 2GiB, or a number of MiB (default: none)")
      ->type_name("SIZE");
  add_positive_option(command, "--max-element", s.max_element, "M",
                      "longest element edge in metres (default: by accuracy and size)");
  add_detail_option(command, s.detail);
  command.add_flag("--layers", s.layers,
                   "also each group of luminaires and of glowing materials, sky and sun by itself, for clerestory mix");
  command
      .add_option("--times", arguments->times,
                  "a series in one solve: sky and sun of each time, 2026-03-21T06:00/20:00/PT1H; one OUT.TIME.vtp each")
      ->type_name("FROM/TO/STEP")
      ->excludes("--layers");
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
      std::vector<NamedFile> files = {{"--sensors", arguments->sensors, false}, {"-o", arguments->output}};
      if (arguments->sensors_output.empty())
        files.push_back(
            {"the sensors' output", sensors_output(*arguments).string(), true, "name another: --sensors-out"});
      else
        files.push_back({"--sensors-out", arguments->sensors_output});
      for (const auto& file : files_of_times(*arguments)) files.push_back({"--times", file.string()});
      if (!arguments->solve.debug_output.empty())
        for (const auto& file : debug_files(arguments->solve.debug_output))
          files.push_back({"--debug-output", file.string()});
      return run(arguments->common, arguments->input, std::move(files),
                 [&](Console& console) { return solve_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
