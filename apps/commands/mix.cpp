// clerestory mix: a result in layers, lit anew.

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/dim_arguments.h"
#include "apps/finish_report.h"
#include "apps/layer_arguments.h"
#include "apps/run.h"
#include "apps/solution_warnings.h"
#include "apps/solve_report.h"
#include "io/annual/year_part_tables.h"
#include "io/atomic_file.h"
#include "io/read_result.h"
#include "io/read_run_report.h"
#include "io/write_result.h"
#include "io/write_sensors.h"
#include "pipeline/lap.h"
#include "pipeline/mix/mix_layers.h"
#include "pipeline/scene_of_result.h"
#include "pipeline/wording.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

struct Arguments {
  CommonArguments common;
  std::string input, output, sensors_output;
  std::vector<std::string> set;
  DimArguments dim;
};

void write_mixed_sensors(AtomicFile& file, const WrittenResult& mixed) {
  std::vector<SensorSet> sets;
  SensorLayers layers;
  for (const MeasuredSensors& sensors : mixed.around.sensors) sets.push_back(sensors.set);
  for (const ShownLayer& layer : mixed.around.layers) layers.names.push_back(layer.name);
  SensorLight light = sensor_light(mixed);
  layers.E = std::move(light.layers);
  write_sensors(file, all_sensor_points(sets), light.E, {}, layers);
}

void say_mix(const RunReport& report, const RunReport& before, Console& console) {
  const EnergyBalance& energy = report.energy;
  console.say("  energy  emitted " + rounded(energy.emitted, 4) + " W, absorbed " + rounded(energy.absorbed, 4) +
              " W, escaped " + rounded(energy.escaped, 4) + " W, imbalance " + percent(energy.imbalance()));
  if (!report.error && before.error)
    console.say("  error   not measured of this light; before, " + percent(before.error->rms_relative) + " rms");
  for (const ShownLayer& layer : report.layers)
    console.say("  layer   " + layer_line(layer) + ", " + rounded(layer.factor, 4) + " times as solved");
  if (!report.sensors.empty())
    for (const std::string& line : sensor_table(report.sensors)) console.say("  " + line);
}

/// "dimmed  'windows'=0.2000, 'middle'=0.6000: 8,960 lm of 26,880 lm, 66.7 % saved"
void say_found(const FoundFactors& found, Console& console) {
  std::string line = "  dimmed  " + factor_words(found.factors, 4) + ": " + rounded(found.luminous_flux, 4) +
                     " lm of " + rounded(found.full_flux, 4) + " lm";
  if (found.luminous_flux == 0)
    line += "; there is enough light without";
  else if (found.luminous_flux <= found.full_flux)
    line += ", " + percent(1 - found.luminous_flux / found.full_flux) + " saved";
  console.say(line);
}

/// set  factors that the command line gives.
ExitCode mix_command(const Arguments& arguments, std::vector<LayerFactor> set, Console& console) {
  check_writable(arguments.output);
  if (!arguments.sensors_output.empty()) check_writable(arguments.sensors_output);
  Lap lap;
  WrittenResult result = read_result(arguments.input);
  require_whole_year(result);
  console.has_read(files_of_scene(result, arguments.input));
  double read = 0;
  lap.add_to(read);
  if (!arguments.sensors_output.empty() && result.around.sensors.empty())
    throw InputError("--sensors-out " + arguments.sensors_output + ": " + arguments.input + " has no sensors.");

  std::optional<FoundFactors> found;
  if (const auto request = dim_request(arguments.dim)) {
    found = find_factors(result, set, *request);
    set.insert(set.end(), found->factors.begin(), found->factors.end());
  }
  const std::vector<double> factors = factors_of(result, set);
  mix_layers(result, factors);
  const RunReport before = run_report_of(result.report, result.file);
  RunReport report = report_of_mix(before, result, factors);
  repeat_warnings(result, console);

  Lap writing;
  Outputs outputs;
  write_result(outputs.open(arguments.output), result, report);
  if (!arguments.sensors_output.empty()) write_mixed_sensors(outputs.open(arguments.sensors_output), result);
  report.seconds.read = read;
  writing.add_to(report.seconds.write);
  finish_report(report, arguments.common, console, outputs);
  console.say(arguments.input + ": " + counted(factors.size(), "layer") + " of " + report.input);
  if (found) say_found(*found, console);
  say_mix(report, before, console);
  console.commit(outputs);
  console.say("  results " + arguments.output +
              (arguments.sensors_output.empty() ? "" : ", " + arguments.sensors_output) +
              (arguments.common.report.empty() ? "" : ", " + arguments.common.report));
  return kDone;
}

}  // namespace

void add_mix_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      *program.add_subcommand("mix", "a result in layers, lit anew: luminaires dimmed, sky and sun changed");
  add_solution_input(command, arguments->input, "a result of clerestory solve --layers");
  command.add_option("-o,--output", arguments->output, "the result under this light, with its layers")
      ->type_name("OUT.vtp")
      ->required();
  require_extension(command, "--output", {".vtp"});
  add_set_option(command, arguments->set);
  add_dim_options(command, arguments->dim);
  command.add_option("--sensors-out", arguments->sensors_output, "what sensors receive of it (default: not written)")
      ->type_name("OUT.csv");
  add_common_options(command, arguments->common);
  command.footer(
      "example: clerestory mix classroom.vtp -o dimmed.vtp --set windows=0.2 --set middle=0.6\n         clerestory mix "
      "classroom.vtp -o dimmed.vtp --target 'work plane=300' --uniformity 0.6");
  command.callback([arguments, &task] {
    if (arguments->set.empty() && arguments->dim.targets.empty())
      throw CLI::ValidationError("mix", "needs --set LAYER=FACTOR or --target GRID=LUX");
    task = [arguments, set = layer_factors(arguments->set)] {
      return run(arguments->common, arguments->input,
                 {{"-o", arguments->output}, {"--sensors-out", arguments->sensors_output}},
                 [&](Console& console) { return mix_command(*arguments, set, console); });
    };
  });
}

}  // namespace clerestory
