// clerestory annual: scene and weather -> daylight figures of a year.

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/effective_settings.h"
#include "apps/finish_report.h"
#include "apps/run.h"
#include "apps/solve_report.h"
#include "io/as_written.h"
#include "io/formats/weather_year.h"
#include "io/read_sensors.h"
#include "io/write_result.h"
#include "pipeline/annual/solve_year.h"
#include "pipeline/collect_around.h"
#include "pipeline/wording.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

struct Arguments {
  CommonArguments common;
  SolveArguments solve;
  ReadOptions read;
  std::string input, output, weather, sensors;
  std::optional<std::string> sky_parts;
};

ExitCode annual_command(const Arguments& arguments, Console& console) {
  RunReport report = new_report(arguments.input);
  ReadOptions read = arguments.read;
  read.for_a_year = true;
  Scene scene = read_scene(arguments.input, read);
  if (!arguments.sensors.empty()) scene.sensors = {read_sensors(arguments.sensors)};
  const Weather weather = read_epw(arguments.weather);
  const DaylightYear year =
      daylight_year(weather, scene.place.value_or(weather.place), scene.north_deg, scene.ground_reflectance);
  for (const std::string& line : year.warnings) console.warn(line);
  YearSettings settings;
  settings.solve = effective_settings(arguments.common, arguments.solve, scene);
  settings.is_occupied.assign(kHoursOfYear, 0);
  for (std::size_t h = 0; h < kHoursOfYear; ++h) settings.is_occupied[h] = h % 24 >= 8 && h % 24 < 18;
  if (arguments.sky_parts) settings.sky_parts = std::stoul(*arguments.sky_parts);
  const YearSolved solved = solve_year(scene, year, settings, console);
  console.say("hours " + std::to_string(solved.hours.size()) + " nodes " + std::to_string(solved.sun_nodes) + " points " +
              std::to_string(solved.of_points.size()));
  console.say("error total " + std::to_string(solved.error.total) + " direct " + std::to_string(solved.error.direct));
  for (const auto& e : {solved.error_sensors, solved.error_points})
    if (e) console.say("rms " + std::to_string(e->rms_relative) + " +- " + std::to_string(e->confidence) + " bias " + std::to_string(e->bias_relative)+ " med " + std::to_string(e->median_relative)+ " p95 " + std::to_string(e->p95_relative));
  for (const auto* areas : {&solved.rooms, &solved.grids})
    for (const YearArea& a : *areas)
      console.say(a.name + ": sDA " + std::to_string(a.figures.sDA.value) + " (" + std::to_string(a.figures.sDA.low) +
                  ".." + std::to_string(a.figures.sDA.high) + ") ASE " + std::to_string(a.figures.ASE_more_than.value) +
                  " mean " + std::to_string(a.figures.mean));
  WrittenResult result = as_written(solved.solved.patches, solved.solved.lightmap, solved.solved.solution,
                                    collect_around(scene, solved.solved), {});
  for (const YearFigure& figure : year_figures(solved.rules)) {
    WrittenArray& of_points = result.of_points[figure.name];
    for (const PointYear& p : solved.of_points)
      of_points.value.push_back(static_cast<float>(figure(p, solved.rules)));
    WrittenArray& of_cells = result.of_cells[figure.name];
    for (const auto& c : result.triangles)
      of_cells.value.push_back((of_points.value[c[0]] + of_points.value[c[1]] + of_points.value[c[2]]) / 3);
  }
  Outputs outputs;
  write_result(outputs.open(arguments.output), result, report);
  console.commit(outputs);
  return kDone;
}

}  // namespace

void add_annual_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *program.add_subcommand("annual", "daylight of a year on every vertex, sensor and room");
  add_input_options(command, arguments->input, arguments->read);
  command.add_option("--weather", arguments->weather, "weather of a typical year")->type_name("CITY.epw")->required();
  command.add_option("-o,--output", arguments->output, "the result, for ParaView")->type_name("OUT.vtp")->required();
  require_extension(command, "--output", {".vtp"});
  command.add_option("--sensors", arguments->sensors, "points to report on, x,y,z,nx,ny,nz in metres")
      ->type_name("POINTS.csv");
  add_choice(command, "--sky-parts", arguments->sky_parts, {"145", "577", "2305"}, "parts of the sky (default: by accuracy)");
  add_checked_word(command, "--accuracy", arguments->solve.accuracy, problem_with_accuracy,
                   "draft, standard or fine (default: standard)");
  add_common_options(command, arguments->common);
  command.callback([arguments, &task] {
    task = [arguments] {
      return run(arguments->common, arguments->input,
                 {{"--weather", arguments->weather, false}, {"--sensors", arguments->sensors, false}, {"-o", arguments->output}},
                 [&](Console& console) { return annual_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
