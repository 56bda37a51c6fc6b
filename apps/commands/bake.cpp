// clerestory bake: a solution as a lightmap that other programs show.

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/finish_report.h"
#include "apps/run.h"
#include "apps/solution_warnings.h"
#include "io/annual/year_part_tables.h"
#include "io/bake/atlas_files.h"
#include "io/bake/baked_files.h"
#include "io/picture/encode.h"
#include "io/read_result.h"
#include "io/run_report.h"
#include "meshing/atlas/make_atlas.h"
#include "pipeline/bake/bake_model.h"
#include "pipeline/scene_of_result.h"
#include "pipeline/wording.h"
#include "solver/model/bake_points.h"
#include "solver/model/error.h"
#include "solver/model/exposure.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

struct Arguments {
  CommonArguments common;
  std::string input, output, scene;
  std::optional<std::string> detail;
  double exposure = 0;
  std::optional<double> texels_per_metre;
  bool lightmap_extension = false;

  bool has(const char* extension) const { return output.ends_with(extension); }
  bool wants_atlas() const { return texels_per_metre || has(kExr); }
  /// The file beside the .glb or .exr with another extension.
  std::string beside(const char* extension) const { return output.substr(0, output.size() - 4) + extension; }
  static constexpr const char *kGlb = ".glb", *kExr = ".exr", *kPng = ".png", *kJson = ".json";
  static constexpr double kTexelsPerMetre = 20;  ///< where none are asked for

  /// All that is written: beside the GLB its textures, beside the EXR what its charts are.
  std::vector<NamedFile> files() const {
    std::vector<NamedFile> all{{"--scene", scene, false}, {"-o", output}};
    const auto add = [&](const char* extension) {
      all.push_back({"-o", beside(extension), true, "its name comes from -o: choose another"});
    };
    if (wants_atlas() && has(kGlb)) add(kExr), add(kPng);
    if (has(kExr)) add(kJson);
    return all;
  }
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

constexpr double kChanged = 0.002, kAnother = 0.5;  ///< share of the surfaces; less is rounding, more another model

Counts write_model_detail(AtomicFile& file, const WrittenResult& result, const Arguments& arguments, Console& console,
                          double exposure) {
  const Scene scene = read_scene_of(result, arguments.input, arguments.scene);
  console.has_read(scene.files);
  const BakedScene baked = bake_scene(result, scene);
  if (baked.missing_share > kAnother)
    throw InputError(scene.file + ": is not what " + result.file + " was solved for: it has no face where " +
                     percent(baked.missing_share) +
                     " of the surfaces there are; name the right one by --scene FILE, or solve this one.");
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

void say_atlas(const LightmapAtlas& atlas, const WrittenResult& result, Console& console) {
  const AtlasError& error = atlas.error;
  console.say("atlas: " + counted(atlas.charts.size(), "chart") + " on " + grouped(static_cast<unsigned>(atlas.width)) +
              " x " + grouped(static_cast<unsigned>(atlas.height)) + " texels, " + percent(atlas.used) + " used");
  std::string line = "lookups: " + percent(error.share_within_1_percent) + " of the surface within 1 %, 95 % within " +
                     percent(error.p95) + ", 99 % within " + percent(error.p99);
  if (error.worst > 0)
    line +=
        "; the worst point " + percent(error.worst) + " off, at surface '" + result.surfaces[error.worst_surface] + "'";
  console.say(line);
}

/// The texture lightmap, and the GLB that it belongs to.
Counts write_with_atlas(const Arguments& arguments, const WrittenResult& result, double exposure, Outputs& outputs,
                        Console& console) {
  const LightmapAtlas atlas =
      make_atlas(result, arguments.texels_per_metre.value_or(Arguments::kTexelsPerMetre), console.monitor());
  const BakedMesh mesh = with_atlas(baked_points(result), atlas);
  write_atlas_exr(outputs.open(arguments.beside(Arguments::kExr)), atlas);
  if (arguments.has(Arguments::kExr)) write_atlas_json(outputs.open(arguments.beside(Arguments::kJson)), atlas, result);
  if (arguments.has(Arguments::kGlb)) {
    const std::string picture = arguments.beside(Arguments::kPng);
    write_atlas_png(outputs.open(picture), atlas, exposure);
    write_baked_glb(outputs.open(arguments.output), mesh, names_of(result),
                    {exposure, std::filesystem::path(picture).filename().string(), arguments.lightmap_extension});
  }
  say_atlas(atlas, result, console);
  return {mesh.position.size(), mesh.triangles.size()};
}

ExitCode bake_command(const Arguments& arguments, Console& console) {
  if (!arguments.scene.empty() && arguments.detail != "model") {
    console.fail("--scene is for --detail model only: the light of a solution needs no model.");
    return kWrongUsage;
  }
  if (arguments.texels_per_metre && !arguments.has(Arguments::kGlb) && !arguments.has(Arguments::kExr)) {
    console.fail("--texels-per-metre is for .glb and .exr: " + arguments.output + " holds no texture coordinates");
    return kWrongUsage;
  }
  if (arguments.lightmap_extension && !(arguments.has(Arguments::kGlb) && arguments.texels_per_metre)) {
    console.fail("--lightmap-extension is for a .glb with --texels-per-metre");
    return kWrongUsage;
  }
  if (arguments.detail == "model" && arguments.wants_atlas()) {
    console.fail("a texture lightmap is of the mesh that the light needs: leave --detail model out");
    return kWrongUsage;
  }
  for (const NamedFile& file : arguments.files())
    if (file.is_written) check_writable(file.file);
  if (arguments.wants_atlas()) require_picture_files();
  const WrittenResult result = read_result(arguments.input);
  require_whole_year(result);
  console.has_read(files_of_scene(result, arguments.input));
  const double exposure = exposure_of(result, arguments.exposure);
  Outputs outputs;
  Counts counts;
  if (arguments.wants_atlas())
    counts = write_with_atlas(arguments, result, exposure, outputs, console);
  else if (arguments.detail == "model")
    counts = write_model_detail(outputs.open(arguments.output), result, arguments, console, exposure);
  else
    counts = write_light_detail(outputs.open(arguments.output), result, exposure);
  repeat_warnings(result, console);
  RunReport report = new_report(arguments.input);
  report.counts.triangles = counts.triangles;
  report.counts.points = counts.points;
  report.settings = {{"detail", arguments.detail.value_or("light")}, {"exposure", exposure}};
  if (arguments.wants_atlas())
    report.settings.push_back({"texels_per_metre", arguments.texels_per_metre.value_or(Arguments::kTexelsPerMetre)});
  finish_report(report, arguments.common, console, outputs);
  console.say(arguments.input + ": light on " + counted(counts.points, "point") + " of " +
              counted(counts.triangles, "triangle") + ", white at " + rounded(kWhiteEfficacy / exposure) + " lx");
  console.commit(outputs);
  for (const NamedFile& file : arguments.files())
    if (file.is_written) console.say("lightmap " + file.file);
  return kDone;
}

}  // namespace

void add_bake_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *program.add_subcommand("bake", "a solution as a lightmap for other programs");
  add_solution_input(command, arguments->input);
  command
      .add_option("-o,--output", arguments->output,
                  "the lightmap: by its name PLY, OBJ, binary glTF, or EXR, a texture alone")
      ->type_name("OUT.ply|.obj|.glb|.exr")
      ->required();
  require_extension(command, "--output", {".ply", ".obj", ".glb", ".exr"});
  add_positive_option(command, "--texels-per-metre", arguments->texels_per_metre, "N",
                      "a texture lightmap, so fine: OUT.exr in lux and OUT.png beside the .glb (default: none; 20 for "
                      ".exr)");
  command.add_flag("--lightmap-extension", arguments->lightmap_extension,
                   "the texture as MOZ_lightmap and not as base colour");
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
      return run(arguments->common, arguments->input, arguments->files(),
                 [&](Console& console) { return bake_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
