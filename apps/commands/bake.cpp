// clerestory bake: a solution as a lightmap that other programs show.

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/finish_report.h"
#include "apps/run.h"
#include "io/bake/baked_files.h"
#include "io/read_result.h"
#include "io/run_report.h"
#include "pipeline/bake/bake_model.h"
#include "pipeline/bake/scene_of_result.h"
#include "pipeline/wording.h"
#include "solver/model/bake_points.h"
#include "solver/model/exposure.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

struct Arguments {
  CommonArguments common;
  std::string input, output, scene;
  std::optional<std::string> detail;
  double exposure = 0;
};

bool is_of(const AtomicFile& file, const char* extension) { return file.destination().string().ends_with(extension); }

void write_mesh(AtomicFile& file, const BakedMesh& mesh, const BakedNames& names, double exposure) {
  if (is_of(file, ".ply")) write_baked_ply(file, mesh, exposure);
  if (is_of(file, ".obj")) write_baked_obj(file, mesh, names, exposure);
  if (is_of(file, ".glb")) write_baked_glb(file, mesh, names, {exposure, {}});
}

struct Counts {
  std::size_t points = 0, triangles = 0;
};

Counts write_light_detail(AtomicFile& file, const WrittenResult& result, double exposure) {
  const BakedMesh mesh = baked_points(result);
  write_mesh(file, mesh, names_of(result), exposure);
  return {mesh.position.size(), mesh.triangles.size()};
}

constexpr double kChanged = 0.002;  ///< share of the surfaces; less is rounding

Counts write_model_detail(AtomicFile& file, const WrittenResult& result, const Arguments& arguments, Console& console,
                          double exposure) {
  const Scene scene = read_scene_of(result, arguments.input, arguments.scene);
  console.has_read(scene.files);
  const BakedScene baked = bake_scene(result, scene);
  if (baked.missing_share > kChanged)
    console.warn(scene.file + ": has no face where " + percent(baked.missing_share) +
                 " of the solution's surfaces are; was it changed? Then solve it again.");
  if (is_of(file, ".glb")) {
    for (const std::string& texture : write_model_glb(file, baked.models, baked.names, exposure))
      console.warn(scene.file + ": its texture '" + texture + "' cannot be read and is left out.");
  } else {
    const NamedMesh all = as_one_mesh(baked);
    write_mesh(file, all.mesh, all.names, exposure);
  }
  Counts counts;
  for (const LitPart& part : baked.parts)
    counts.points += part.vertex.size(), counts.triangles += part.triangles.size();
  return counts;
}

ExitCode bake_command(const Arguments& arguments, Console& console) {
  if (!arguments.scene.empty() && arguments.detail != "model") {
    console.fail("--scene is for --detail model only: the light of a solution needs no model.");
    return kWrongUsage;
  }
  check_writable(arguments.output);
  const WrittenResult result = read_result(arguments.input);
  const double exposure = exposure_of(result, arguments.exposure);
  Outputs outputs;
  AtomicFile& file = outputs.open(arguments.output);
  const Counts counts = arguments.detail == "model" ? write_model_detail(file, result, arguments, console, exposure)
                                                    : write_light_detail(file, result, exposure);
  RunReport report = new_report(arguments.input);
  report.counts.triangles = counts.triangles;
  report.counts.points = counts.points;
  finish_report(report, arguments.common, console, outputs);
  console.say(arguments.input + ": light on " + counted(counts.points, "point") + " of " +
              counted(counts.triangles, "triangle") + ", white at " + rounded(kWhiteEfficacy / exposure) + " lx");
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
  add_choice(command, "--detail", arguments->detail, {"light", "model"},
             "vertices: of the mesh that the light needs, or the model's own (default: light)");
  command
      .add_option("--scene", arguments->scene,
                  "the scene or model that was solved, for --detail model (default: where it was)")
      ->type_name("FILE");
  add_exposure_option(command, arguments->exposure);
  add_common_options(command, arguments->common);
  command.footer("example: clerestory bake office.vtp -o office.glb");
  command.callback([arguments, &task] {
    task = [arguments] {
      return run(arguments->common, arguments->input, {{"--scene", arguments->scene, false}, {"-o", arguments->output}},
                 [&](Console& console) { return bake_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
