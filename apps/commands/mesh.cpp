// clerestory mesh: the patches that a solve would start from, and how good they are.

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/effective_settings.h"
#include "apps/finish_report.h"
#include "apps/mesh_summary.h"
#include "apps/run.h"
#include "io/atomic_file.h"
#include "io/write_result.h"
#include "pipeline/prepare.h"
#include "pipeline/scene_checks.h"
#include "pipeline/wording.h"

namespace clerestory {
namespace {

struct Arguments {
  CommonArguments common;
  SolveArguments solve;
  ReadOptions read;
  std::string input, output;
};

ExitCode mesh_command(const Arguments& arguments, Console& console) {
  check_writable(arguments.output);
  const Scene scene = read_scene(arguments.input, arguments.read);
  console.has_read(scene.files);
  const Settings settings = effective_settings(arguments.common, arguments.solve, scene);
  warn_about_scene(scene, console);
  RunReport report = new_report(arguments.input);
  report.seconds.read = console.elapsed();

  const auto prepared = prepare(scene, settings, console.monitor(), report.seconds);
  if (!prepared) {
    console.warn("interrupted before the mesh was complete; nothing is written.");
    return kInterrupted;
  }
  const auto& [patches, repairs, rays, lights, lit] = *prepared;

  report.settings = as_figures(settings, patches.channels, arguments.read);
  report.repairs = repairs;
  report.counts.triangles = patches.triangle_count();
  report.counts.elements = patches.patch_count();
  report.counts.dark_sides = lit.dark_sides;
  Outputs outputs;
  write_patches(outputs.open(arguments.output), patches, report);

  console.say(arguments.input + ": " + counted(report.counts.elements, "patch side") + " on " +
              counted(report.counts.triangles, "triangle") + ", " + counted(lit.dark_sides, "dark side") + " left out");
  say_mesh(repairs, console);
  finish_report(report, arguments.common, console, outputs);
  console.commit(outputs);
  console.say("results " + arguments.output);
  return kDone;
}

}  // namespace

void add_mesh_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *program.add_subcommand("mesh", "the patches a solve would start from, with quality figures");
  add_input_options(command, arguments->input, arguments->read);
  command.add_option("-o,--output", arguments->output, "the patches, for ParaView")
      ->type_name("PATCHES.vtp")
      ->required();
  require_extension(command, "--output", {".vtp"});
  add_positive_option(command, "--max-element", arguments->solve.max_element, "M",
                      "longest element edge in metres (default: by accuracy and size)");
  add_detail_option(command, arguments->solve.detail);
  add_checked_word(command, "--accuracy", arguments->solve.accuracy, problem_with_accuracy,
                   "draft, standard or fine (default: standard)");
  add_common_options(command, arguments->common);
  command.footer("example: clerestory mesh data/scenes/house.json -o patches.vtp --max-element 0.25");
  command.callback([arguments, &task] {
    task = [arguments] {
      return run(arguments->common, arguments->input, {{"-o", arguments->output}},
                 [&](Console& console) { return mesh_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
