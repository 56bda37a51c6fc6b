// clerestory merge: the parts of a year -> the year.

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/finish_report.h"
#include "apps/run.h"
#include "apps/year_outputs.h"
#include "io/read_result.h"
#include "pipeline/annual/year_parts.h"
#include "pipeline/annual/year_report.h"
#include "pipeline/wording.h"

namespace clerestory {
namespace {

struct Arguments {
  CommonArguments common;
  std::vector<std::string> parts;
  YearFiles files;
};

ExitCode merge_command(const Arguments& arguments, Console& console) {
  check_writable(arguments.files.output);
  console.has_read({});
  YearMerge merge;
  for (const std::string& file : arguments.parts) {
    WrittenResult result = read_result(file);
    result.file = file;  // parts may be called alike, in folders of their own
    merge.add(std::move(result));
  }
  MergedYear year = merge.finish();
  arguments.files.check_places(!year.sensors.empty());
  for (const std::string& warning : year.report.warnings) console.warn(warning);
  for (const std::string& warning : warnings_of(year.annual)) console.warn(warning);
  year.report.warnings = console.warnings();  // as one run has them
  Outputs outputs;
  write_year(arguments.files, year.result, year.solved, year.annual, year.sensors, year.report, outputs);
  finish_report(year.report, arguments.common, console, outputs);
  console.say(arguments.files.output + ": " + counted(arguments.parts.size(), "part") + ", " +
              counted(year.solved.of_points.size(), "point") + ", " + counted(year.solved.of_sensors.size(), "sensor"));
  for (const std::string& line : lines_of(year.annual)) console.say("  " + line);
  console.commit(outputs);
  console.say("  results " + arguments.files.told(year.solved));
  return kDone;
}

}  // namespace

void add_merge_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *program.add_subcommand("merge", "parts of a year, by annual --part, put together");
  command.add_option("PART", arguments->parts, "all parts of one run, in any order")->type_name("PART.vtp")->required();
  command
      .add_option("-o,--output", arguments->files.output,
                  "the year, as one run of annual without --part writes it; rooms and grids go into OUT.json, sensors "
                  "into OUT.sensors.csv")
      ->type_name("OUT.vtp")
      ->required();
  require_extension(command, "--output", {".vtp"});
  command.add_option("--sensors-out", arguments->files.sensors_out, "where to (default: OUT.sensors.csv)")
      ->type_name("OUT.csv");
  add_common_options(command, arguments->common);
  command.footer("example: clerestory merge office_year.1.vtp office_year.2.vtp -o office_year.vtp");
  command.callback([arguments, &task] {
    task = [arguments] {
      std::vector<NamedFile> files = arguments->files.named();
      for (std::size_t i = 1; i < arguments->parts.size(); ++i) files.push_back({"PART", arguments->parts[i], false});
      return run(arguments->common, arguments->parts.front(), std::move(files),
                 [&](Console& console) { return merge_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
