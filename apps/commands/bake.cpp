// clerestory bake: a solution as a lightmap that other programs show.

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/finish_report.h"
#include "apps/run.h"
#include "io/bake/baked_files.h"
#include "io/read_result.h"
#include "io/run_report.h"
#include "pipeline/wording.h"
#include "solver/model/bake_points.h"
#include "solver/model/exposure.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

struct Arguments {
  CommonArguments common;
  std::string input, output;
  double exposure = 0;
};

void write_baked(AtomicFile& file, const BakedMesh& mesh, const WrittenResult& result, double exposure) {
  const std::string extension = file.destination().extension().string();
  if (extension == ".ply") write_baked_ply(file, mesh, exposure);
  if (extension == ".obj") write_baked_obj(file, mesh, result, exposure);
  if (extension == ".glb") write_baked_glb(file, mesh, result, {exposure, {}});
}

ExitCode bake_command(const Arguments& arguments, Console& console) {
  check_writable(arguments.output);
  const WrittenResult result = read_result(arguments.input);
  const double exposure = exposure_of(result, arguments.exposure);
  const BakedMesh mesh = baked_points(result);
  Outputs outputs;
  write_baked(outputs.open(arguments.output), mesh, result, exposure);
  if (console.should_stop()) {
    console.warn("interrupted; nothing is written.");
    return kInterrupted;
  }
  RunReport report = new_report(arguments.input);
  report.counts.triangles = mesh.triangles.size();
  report.counts.points = mesh.position.size();
  finish_report(report, arguments.common, console, outputs);
  console.say(arguments.input + ": " + counted(mesh.position.size(), "point") + " on " +
              counted(mesh.triangles.size(), "triangle") + ", white at " + rounded(kWhiteEfficacy / exposure) + " lx");
  console.commit(outputs);
  console.say("lightmap " + arguments.output);
  return kDone;
}

}  // namespace

void add_bake_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *program.add_subcommand("bake", "a solution as a lightmap for other programs");
  command.add_option("SOLUTION", arguments->input, "what clerestory solve wrote (.vtp)")->type_name("FILE")->required();
  command.add_option("-o,--output", arguments->output, "the lightmap: by its name PLY, OBJ or binary glTF")
      ->type_name("OUT.ply|.obj|.glb")
      ->required();
  require_extension(command, "--output", {".ply", ".obj", ".glb"});
  add_exposure_option(command, arguments->exposure);
  add_common_options(command, arguments->common);
  command.footer("example: clerestory bake office.vtp -o office.glb");
  command.callback([arguments, &task] {
    task = [arguments] {
      return run(arguments->common, arguments->input, {{"-o", arguments->output}},
                 [&](Console& console) { return bake_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
