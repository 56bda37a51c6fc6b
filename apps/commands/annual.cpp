// clerestory annual: a scene and the weather of a year -> daylight figures on every vertex, sensor and room.

#include <algorithm>
#include <filesystem>
#include <memory>
#include <tuple>
#include <utility>

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/effective_settings.h"
#include "apps/finish_report.h"
#include "apps/run.h"
#include "apps/solve_report.h"
#include "apps/year_arguments.h"
#include "apps/year_outputs.h"
#include "apps/year_series.h"
#include "io/annual/file_digest.h"
#include "io/annual/year_part_tables.h"
#include "io/as_written.h"
#include "io/formats/weather_year.h"
#include "io/input_file.h"
#include "io/read_schedule.h"
#include "io/read_sensors.h"
#include "io/text.h"
#include "io/write_result.h"
#include "pipeline/annual/solve_year.h"
#include "pipeline/annual/year_parts.h"
#include "pipeline/annual/year_report.h"
#include "pipeline/collect_around.h"
#include "pipeline/lap.h"
#include "pipeline/wording.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  CommonArguments common;
  SolveArguments solve;
  ReadOptions read;
  std::string input, weather, sensors, schedule = "8-18", hours, honeybee;
  YearFiles files;
  std::vector<double> thresholds;
  std::optional<std::string> sky_parts, part;
};

/// Of what is asked, by the arguments.
YearSettings year_settings(const Arguments& arguments, const Scene& scene, const Schedule& schedule, Console& console) {
  YearSettings settings;
  settings.solve = effective_settings(arguments.common, arguments.solve, scene);
  leave_out_what_a_year_does_not_follow(settings.solve, scene.file, console);
  settings.is_occupied = schedule.occupied;
  if (!arguments.thresholds.empty()) {
    settings.threshold = arguments.thresholds.front();
    settings.more_thresholds.assign(arguments.thresholds.begin() + 1, arguments.thresholds.end());
  }
  if (arguments.sky_parts) settings.sky_parts = std::stoul(*arguments.sky_parts);
  if (arguments.part) std::tie(settings.part, settings.parts) = *part_of(*arguments.part);
  return settings;
}

std::vector<Figure> as_figures(const Arguments& arguments, const Schedule& schedule, const YearSettings& asked,
                               const YearSolved& solved) {
  std::vector<Figure> out = as_figures(solved.solved.settings, solved.solved.patches.channels, arguments.read);
  out.push_back({"weather", fs::path(arguments.weather).filename().string()});
  out.push_back({"schedule", schedule.name});
  out.push_back({"threshold", asked.threshold});
  out.push_back({"sky_parts", static_cast<long long>(solved.sky_parts)});
  out.push_back({"sun_positions", static_cast<long long>(solved.sun_nodes)});
  return out;
}

RunReport::Error figures_of(const ErrorFigures& e) {
  return {e.rms_relative, e.median_relative, e.p95_relative, e.samples, e.confidence, e.bound};
}

WrittenResult written(const Scene& scene, const YearSolved& solved) {
  WrittenResult result = as_written(solved.solved.patches, solved.solved.lightmap, solved.solved.solution,
                                    collect_around(scene, solved.solved), {});
  add_figures(solved, result);
  return result;
}

std::vector<FileOfRun> files_of_run(const Arguments& arguments, const Scene& scene) {
  std::vector<fs::path> files = scene.files;
  files.emplace_back(arguments.weather);
  if (!arguments.sensors.empty()) files.emplace_back(arguments.sensors);
  if (!is_hours_of_day(arguments.schedule)) files.emplace_back(arguments.schedule);
  std::vector<FileOfRun> all;
  for (const fs::path& file : files) all.push_back({short_name(file), file_digest(file)});
  return all;
}

void write_part(const Arguments& arguments, const Scene& scene, const YearSettings& settings, const YearSolved& solved,
                const AnnualReport& annual, const RunReport& report, Outputs& outputs) {
  WrittenResult result = written(scene, solved);
  const YearPart part =
      part_of_year(solved, settings, annual, all_sensor_points(scene.sensors), files_of_run(arguments, scene));
  mark_other_parts(part, result);
  add_year_part(part, result);
  write_result(outputs.open(arguments.files.output), result, report);
}

/// The scene's, or the model's where the scene says none.
double north_of(const Scene& scene, Console& console) {
  if (scene.north_deg != 0 || scene.place || !scene.model_north_deg) return scene.north_deg;
  console.warn(scene.file + ": north is " + rounded(*scene.model_north_deg) +
               " degrees clockwise from +y, as the model says; write \"location\": { \"north\": ... } to have another");
  return *scene.model_north_deg;
}

void warn_of_lamps(const Scene& scene, Console& console) {
  const bool glows = std::ranges::any_of(scene.materials, [](const Material& m) { return m.emits(); });
  if (!scene.lights.luminaires.empty() || glows)
    console.note("the figures are of daylight alone: lamps and glowing surfaces of the scene are off");
}

/// What a part has no use for; nothing where that is well.
std::string not_of_a_part(const Arguments& arguments) {
  if (!arguments.part) return {};
  if (!arguments.files.sensors_out.empty()) return "--sensors-out is for merge: a part writes its sensors into its -o";
  if (!arguments.hours.empty()) return "--hours is of all sensors: run it without --part";
  if (!arguments.honeybee.empty()) return "--honeybee is of all sensors: run it without --part";
  return {};
}

std::string results_of(const Arguments& arguments, const YearSolved& solved) {
  if (!arguments.part) {
    std::string all = arguments.files.told(solved);
    for (const std::string& series : {arguments.hours, arguments.honeybee})
      if (!series.empty()) all += ", " + series;
    return all;
  }
  return arguments.files.output + ": part " + *arguments.part + ", " +
         counted(solved.part_of_points.end - solved.part_of_points.begin, "point") + " and " +
         counted(solved.part_of_sensors.end - solved.part_of_sensors.begin, "sensor") +
         "; clerestory merge puts all parts together";
}

/// Rooms and grids of a part are known when all parts are.
void say_year(const Arguments& arguments, const YearSolved& solved, const AnnualReport& annual, const RunReport& report,
              Console& console) {
  console.say(report.input + ": " + counted(report.counts.elements, "element") + ", " +
              counted(report.counts.points, "point") + ", " + counted(solved.hours.size(), "hour") + " of light by " +
              std::to_string(solved.sky_parts) + " parts of the sky and " + counted(solved.sun_nodes, "position") +
              " of the sun");
  if (!arguments.part)
    for (const std::string& line : lines_of(annual)) console.say("  " + line);
  const auto say_error = [&](const char* where, const std::optional<ErrorFigures>& e, const YearError& near_threshold) {
    if (e)
      console.say("  error   at " + std::string(where) + " in single hours " + (e->bound ? "below " : "") +
                  percent(e->rms_relative) + " rms, 95 % of them within " + percent(e->p95_relative) +
                  "; of what may be wrong about a threshold up to " + percent(near_threshold.total) + " (" +
                  std::to_string(e->samples) + " paired with paths)");
  };
  say_error("sensors", solved.error_sensors, solved.error_of_sensors);
  say_error("vertices", solved.error_points, solved.error_of_points);
}

ExitCode annual_command(const Arguments& arguments, Console& console) {
  if (const std::string problem = not_of_a_part(arguments); !problem.empty()) {
    console.fail(problem);
    return kWrongUsage;
  }
  Lap lap;
  RunReport report = new_report(arguments.input);
  check_writable(arguments.files.output);
  ReadOptions read = arguments.read;
  if (read.sky)
    throw InputError("--sky " + *read.sky + ": the skies of a year come from its weather file; leave --sky out.");
  read.for_a_year = true;
  Scene scene = read_scene(arguments.input, read);
  if (!arguments.sensors.empty()) scene.sensors = {read_sensors(arguments.sensors)};
  const Schedule schedule = read_schedule(arguments.schedule);
  const Weather weather = read_epw(arguments.weather);
  console.has_read(scene.files);
  const DaylightYear year =
      daylight_year(weather, scene.place.value_or(weather.place), north_of(scene, console), scene.ground_reflectance);
  for (const std::string& line : year.warnings) console.warn(line);
  warn_of_lamps(scene, console);
  scene.lights = {};
  YearSettings settings = year_settings(arguments, scene, schedule, console);
  const bool has_sensors = !all_sensor_points(scene.sensors).empty();
  if (!has_sensors && (!arguments.hours.empty() || !arguments.honeybee.empty()))
    throw InputError(
        std::string(arguments.hours.empty() ? "--honeybee" : "--hours") +
        ": there are no sensors whose hours could be written; give --sensors POINTS.csv, or \"sensors\" in "
        "the scene file.");
  if (!arguments.part) arguments.files.check_places(has_sensors);
  YearSeriesFiles series(arguments.hours, arguments.honeybee, scene, year, console);
  settings.keeps_all_hours = series.any();
  lap.add_to(report.seconds.read);

  const YearSolved solved =
      solve_year(scene, year, settings, console,
                 series.any() ? TakeSeries([&](const SensorSeries& s) { series.take(s); }) : TakeSeries());
  const AnnualReport annual = annual_report(scene, year, schedule.name, solved);
  const double read_seconds = report.seconds.read;
  fill_report(report, scene, solved.solved);
  report.seconds.read = read_seconds;
  report.settings = as_figures(arguments, schedule, settings, solved);
  if (solved.error_sensors) report.error_sensors = figures_of(*solved.error_sensors);
  if (solved.error_points) report.error = figures_of(*solved.error_points);
  if (!arguments.part)
    for (const std::string& line : warnings_of(annual)) console.warn(line);
  report.warnings = console.warnings();
  Outputs outputs;
  if (arguments.part)
    write_part(arguments, scene, settings, solved, annual, report, outputs);
  else
    write_year(arguments.files, written(scene, solved), solved, annual, all_sensor_points(scene.sensors), report,
               outputs);
  finish_report(report, arguments.common, console, outputs);
  say_year(arguments, solved, annual, report, console);
  // Figures first: they are whole without the series, which can be asked for again.
  console.commit(outputs);
  series.commit(scene, solved);
  console.say("  results " + results_of(arguments, solved));
  return kDone;
}

}  // namespace

void add_annual_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      *program.add_subcommand("annual", "daylight of a year, hour by hour: DA, UDI, sDA, ASE, EN 17037");
  add_input_options(command, arguments->input, arguments->read);
  command.add_option("--weather", arguments->weather, "weather of a typical year")->type_name("CITY.epw")->required();
  command
      .add_option(
          "-o,--output", arguments->files.output,
          "figures on every vertex, for ParaView; rooms and grids go into OUT.json, sensors into OUT.sensors.csv")
      ->type_name("OUT.vtp")
      ->required();
  require_extension(command, "--output", {".vtp"});
  command.add_option("--schedule", arguments->schedule, "occupied hours of every day, or a file of 8,760 values")
      ->type_name("8-18|FILE")
      ->capture_default_str();
  command
      .add_option("--threshold", arguments->thresholds,
                  "of daylight autonomy [lx]; hours at or above any further ones are counted, too (default: 300)")
      ->type_name("LUX[,LUX...]")
      ->delimiter(',')
      ->expected(1, 1 + static_cast<int>(kMostThresholds))
      ->check(CLI::Validator(problem_with_threshold, ""));
  add_choice(command, "--sky-parts", arguments->sky_parts, {"145", "577", "2305"},
             "parts of the sky (default: 145 for draft, 577 for standard, 2305 for fine)");
  add_checked_word(command, "--accuracy", arguments->solve.accuracy, problem_with_accuracy,
                   "draft, standard or fine (default: standard)");
  command.add_option("--sensors", arguments->sensors, "points to report on, x,y,z,nx,ny,nz in metres")
      ->type_name("POINTS.csv");
  command.add_option("--sensors-out", arguments->files.sensors_out, "where to (default: OUT.sensors.csv)")
      ->type_name("OUT.csv");
  command
      .add_option("--hours", arguments->hours, "illuminance of every sensor in every hour, as HDF5 or NumPy's files")
      ->type_name("FILE.h5|DIR");
  command.add_option("--honeybee", arguments->honeybee, "the same and its figures, as Ladybug Tools read them")
      ->type_name("DIR");
  add_checked_word(command, "--part", arguments->part, problem_with_part,
                   "part i of n of all points and sensors, into OUT.vtp alone; clerestory merge puts parts together")
      ->type_name("I/N");
  add_positive_option(command, "--max-element", arguments->solve.max_element, "M",
                      "longest element edge in metres (default: by accuracy and size)");
  add_detail_option(command, arguments->solve.detail);
  add_common_options(command, arguments->common);
  command.footer("example: clerestory annual data/scenes/office.json --weather city.epw -o office_year.vtp");
  command.callback([arguments, &task] {
    if (const std::string problem = problem_with_thresholds(arguments->thresholds); !problem.empty())
      throw CLI::ValidationError("--threshold", problem);
    task = [arguments] {
      std::vector<NamedFile> files = {{"--weather", arguments->weather, false},
                                      {"--sensors", arguments->sensors, false},
                                      {"--hours", arguments->hours},
                                      {"--honeybee", arguments->honeybee}};
      if (!is_hours_of_day(arguments->schedule)) files.push_back({"--schedule", arguments->schedule, false});
      for (const NamedFile& file : arguments->files.named())
        if (!arguments->part || file.option == "-o") files.push_back(file);
      return run(arguments->common, arguments->input, std::move(files),
                 [&](Console& console) { return annual_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
