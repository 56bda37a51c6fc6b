// clerestory bake: a solution as a lightmap that other programs show.

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/finish_report.h"
#include "apps/run.h"
#include "io/bake/atlas_files.h"
#include "io/bake/baked_files.h"
#include "io/picture/encode.h"
#include "io/read_result.h"
#include "io/run_report.h"
#include "meshing/atlas/make_atlas.h"
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
  std::optional<double> texels_per_metre;
  bool lightmap_extension = false;

  bool has(const char* extension) const { return output.ends_with(extension); }
  bool wants_atlas() const { return texels_per_metre || has(kExr); }
  /// The file beside the output with another extension.
  std::string beside(const char* extension) const {
    return std::filesystem::path(output).replace_extension(extension).string();
  }
  static constexpr const char *kGlb = ".glb", *kExr = ".exr", *kPng = ".png", *kJson = ".json";
  static constexpr double kTexelsPerMetre = 20;  ///< where none are asked for

  /// All that is written: beside the GLB its textures, beside the EXR what its charts are.
  std::vector<NamedFile> files() const {
    std::vector<NamedFile> all{{"-o", output}};
    const auto add = [&](const char* extension) {
      all.push_back({"-o", beside(extension), true, "its name comes from -o: choose another"});
    };
    if (wants_atlas() && has(kGlb)) add(kExr), add(kPng);
    if (has(kExr)) add(kJson);
    return all;
  }
};

void write_baked(AtomicFile& file, const BakedMesh& mesh, const WrittenResult& result, double exposure) {
  const std::string extension = file.destination().extension().string();
  if (extension == ".ply") write_baked_ply(file, mesh, exposure);
  if (extension == ".obj") write_baked_obj(file, mesh, result, exposure);
  if (extension == ".glb") write_baked_glb(file, mesh, result, {exposure, {}});
}

void say_atlas(const LightmapAtlas& atlas, const WrittenResult& result, Console& console) {
  const AtlasError& error = atlas.error;
  console.say("atlas: " + counted(atlas.charts.size(), "chart") + " on " + grouped(static_cast<unsigned>(atlas.width)) +
              " x " + grouped(static_cast<unsigned>(atlas.height)) + " texels, " + percent(atlas.used) +
              " used");
  std::string line = "lookups: " + percent(error.share_within_1_percent) + " of the surface within 1 %, 95 % within " +
                     percent(error.p95) + ", 99 % within " + percent(error.p99);
  if (error.worst > 0)
    line += "; the worst point " + percent(error.worst) + " off, at surface '" + result.surfaces[error.worst_surface] + "'";
  console.say(line);
}

/// The texture lightmap, and the GLB that it belongs to.
BakedMesh write_with_atlas(const Arguments& arguments, const WrittenResult& result, double exposure, Outputs& outputs,
                           Console& console) {
  const LightmapAtlas atlas =
      make_atlas(result, arguments.texels_per_metre.value_or(Arguments::kTexelsPerMetre));
  const BakedMesh mesh = with_atlas(baked_points(result), atlas);
  write_atlas_exr(outputs.open(arguments.beside(Arguments::kExr)), atlas);
  if (arguments.has(Arguments::kExr)) write_atlas_json(outputs.open(arguments.beside(Arguments::kJson)), atlas, result);
  if (arguments.has(Arguments::kGlb)) {
    const std::string picture = arguments.beside(Arguments::kPng);
    write_atlas_png(outputs.open(picture), atlas, exposure);
    write_baked_glb(outputs.open(arguments.output), mesh, result,
                    {exposure, std::filesystem::path(picture).filename().string(), arguments.lightmap_extension});
  }
  say_atlas(atlas, result, console);
  return mesh;
}

ExitCode bake_command(const Arguments& arguments, Console& console) {
  if (arguments.texels_per_metre && !arguments.has(Arguments::kGlb) && !arguments.has(Arguments::kExr)) {
    console.fail("--texels-per-metre is for .glb and .exr: " + arguments.output + " holds no texture coordinates");
    return kWrongUsage;
  }
  if (arguments.lightmap_extension && !(arguments.has(Arguments::kGlb) && arguments.texels_per_metre)) {
    console.fail("--lightmap-extension is for a .glb with --texels-per-metre");
    return kWrongUsage;
  }
  for (const NamedFile& file : arguments.files()) check_writable(file.file);
  if (arguments.wants_atlas()) require_picture_files();
  const WrittenResult result = read_result(arguments.input);
  const double exposure = exposure_of(result, arguments.exposure);
  Outputs outputs;
  BakedMesh mesh;
  if (arguments.wants_atlas()) {
    mesh = write_with_atlas(arguments, result, exposure, outputs, console);
  } else {
    mesh = baked_points(result);
    write_baked(outputs.open(arguments.output), mesh, result, exposure);
  }
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
  for (const NamedFile& file : arguments.files()) console.say("lightmap " + file.file);
  return kDone;
}

}  // namespace

void add_bake_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *program.add_subcommand("bake", "a solution as a lightmap for other programs");
  command.add_option("SOLUTION", arguments->input, "what clerestory solve wrote (.vtp)")->type_name("FILE")->required();
  command.add_option("-o,--output", arguments->output, "the lightmap: by its name PLY, OBJ, binary glTF, or EXR, a texture alone")
      ->type_name("OUT.ply|.obj|.glb|.exr")
      ->required();
  require_extension(command, "--output", {".ply", ".obj", ".glb", ".exr"});
  add_positive_option(command, "--texels-per-metre", arguments->texels_per_metre, "N",
                      "a texture lightmap, so fine: OUT.exr in lux and OUT.png beside the .glb (default: none; 20 for "
                      ".exr)");
  command.add_flag("--lightmap-extension", arguments->lightmap_extension,
                   "the texture as MOZ_lightmap and not as base colour");
  add_exposure_option(command, arguments->exposure);
  add_common_options(command, arguments->common);
  command.footer("example: clerestory bake office.vtp -o office.glb");
  command.callback([arguments, &task] {
    task = [arguments] {
      return run(arguments->common, arguments->input, arguments->files(),
                 [&](Console& console) { return bake_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
