// clerestory report: a result as one page.

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/finish_report.h"
#include "apps/run.h"
#include "apps/target_arguments.h"
#include "io/annual/year_part_tables.h"
#include "io/atomic_file.h"
#include "io/read_result.h"
#include "io/read_run_report.h"
#include "pipeline/scene_of_result.h"
#include "pipeline/wording.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

struct Arguments {
  CommonArguments common;
  std::string input, output;
  std::vector<std::string> targets;
};

ExitCode report_command(const Arguments& arguments, Console& console) {
  check_writable(arguments.output);
  const PageFiles files = read_page_files();
  const WrittenResult result = read_result(arguments.input);
  require_whole_year(result);
  console.has_read(files_of_scene(result, arguments.input));
  if (result.texts.contains("settings.schedule"))
    throw InputError(arguments.input +
                     ": is a year of daylight, and a page tells of light at one time; its figures are in the .json and "
                     ".sensors.csv beside it, and render --show DA_300 draws them.");
  const ReportTargets targets = report_targets(arguments.targets);
  RunReport report = new_report(arguments.input);
  report.seconds.read = console.elapsed();

  if (!files.why_no_viewer.empty()) console.warn("the page has no 3D view: " + files.why_no_viewer + ".");
  const std::string page = report_page(result, run_report_of(result.report, result.file), files, targets);
  Outputs outputs;
  outputs.open(arguments.output).write(page);
  finish_report(report, arguments.common, console, outputs);
  console.say("results " + arguments.output + ", " + bytes(page.size()) + "; open it in a browser");
  console.commit(outputs);
  return kDone;
}

}  // namespace

void add_report_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *program.add_subcommand("report", "a result as one page: figures, plans, a 3D view");
  add_solution_input(command, arguments->input);
  command.add_option("-o,--output", arguments->output, "the page; it needs no other file and no network")
      ->type_name("REPORT.html")
      ->required();
  require_extension(command, "--output", {".html"});
  add_target_option(command, arguments->targets);
  add_common_options(command, arguments->common);
  command.footer("example: clerestory report office.vtp -o office.html --target 300 --target 'desk height=500'");
  command.callback([arguments, &task] {
    task = [arguments] {
      return run(arguments->common, arguments->input, {{"-o", arguments->output}},
                 [&](Console& console) { return report_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
