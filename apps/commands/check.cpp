// clerestory check: what is in a model, what is wrong with it, and what a solve would make of it. Nothing is solved.

#include <cmath>

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/effective_settings.h"
#include "apps/finish_report.h"
#include "apps/mesh_summary.h"
#include "apps/run.h"
#include "pipeline/panel_hints.h"
#include "pipeline/prepare.h"
#include "pipeline/scene_checks.h"
#include "pipeline/wording.h"
#include "solver/lights/luminaire.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

struct Arguments {
  CommonArguments common;
  SolveArguments solve;
  ReadOptions read;
  std::string input;
};

std::string colour(const Spectrum& s) {
  return s.is_grey() ? rounded(s[0]) : "(" + rounded(s[0]) + ", " + rounded(s[1]) + ", " + rounded(s[2]) + ")";
}

std::string describe(const Material& m) {
  std::string text = m.lets_rays_pass() ? "glass" : "reflectance " + colour(m.reflectance);
  if (m.turns_rays()) text = "mirror, " + text;
  if (m.lets_rays_pass() || m.scatters_through()) text += ", transmittance " + colour(m.transmittance);
  if (m.total_power)
    text += ", emits " + colour(*m.total_power) + " W in all";
  else if (m.emits())
    text += ", emits " + colour(m.exitance) + " W/m2 (" + rounded(photometric(m.exitance)) + " lm/m2)";
  if (m.sides == 1) text += ", one-sided";
  return text;
}

void say_materials(const Scene& scene, Console& console) {
  std::vector<std::size_t> faces(scene.materials.size(), 0);
  for (const MaterialId m : scene.polygons.material) ++faces[m];
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (faces[i])
      console.say("  material '" + scene.materials[i].name + "': " + describe(scene.materials[i]) + ", " +
                  counted(faces[i], "face"));
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (!faces[i]) console.say("  material '" + scene.materials[i].name + "': not used by any face");
}

std::string describe(SkyModel model) {
  switch (model) {
    case SkyModel::uniform:
      return "uniform";
    case SkyModel::cie_overcast:
      return "CIE overcast";
    case SkyModel::cie_clear:
      return "CIE clear";
    case SkyModel::cie_general:
      return "CIE general";
    case SkyModel::perez:
      return "Perez";
    case SkyModel::image:
      return "image";
    case SkyModel::mean:
      return "mean of several";
  }
  return "";
}

void say_lights(const Scene& scene, Console& console) {
  const LightSpec& l = scene.lights;
  for (const Luminaire& luminaire : l.luminaires) {
    const auto* file = std::get_if<WebLuminaire>(&luminaire.kind);
    console.say("  light    " + (file ? "" : std::string(kLuminaireKindNames[luminaire.kind.index()]) + " ") +
                "luminaire '" + luminaire.name + "'" + (file ? " of " + file->web->name : "") + ", " +
                rounded(photometric(power(luminaire))) + " lm");
  }
  if (l.sky)
    console.say("  light    " + describe(l.sky->model) + " sky, " + rounded(photometric(l.sky->horizontal_irradiance)) +
                " lx on open ground, " +
                (l.sky->image_has_ground ? "ground as in the image"
                                         : "ground reflectance " + rounded(l.sky->ground_reflectance)));
  for (const auto& s : l.suns)
    console.say("  light    sun from (" + rounded(s.direction.x) + ", " + rounded(s.direction.y) + ", " +
                rounded(s.direction.z) + "), " + rounded(photometric(s.normal_irradiance)) + " lx");
  std::size_t glowing = 0;
  for (const MaterialId m : scene.polygons.material) glowing += scene.materials[m].emits();
  if (glowing) console.say("  light    " + counted(glowing, "face") + " of emitting materials");
  if (!has_light(scene))
    console.warn(scene.file + ": there is no light; a solve would be refused. Add --sky NAME:LUX.");
}

void say_spaces(const std::vector<RunReport::Space>& spaces, Console& console) {
  for (const RunReport::Space& s : spaces)
    console.say("  space    '" + s.name + "'" + (s.long_name.empty() ? "" : " (" + s.long_name + ")") + ": " +
                (s.volume > 0 ? rounded(s.area) + " m2, " + rounded(s.height) + " m high, " + rounded(s.volume) + " m3"
                              : "without a volume"));
}

void say_not_read(const Scene& scene, Console& console) {
  for (const NotRead& n : scene.not_read)
    console.say("  not read " + std::to_string(n.count) + " x " + n.what +
                (n.first.empty() ? "" : ", the first '" + n.first + "'"));
  if (scene.model_north_deg && std::abs(*scene.model_north_deg) > 0.01)
    console.say("  north    " + rounded(*scene.model_north_deg) + " degrees clockwise from +y, by the model");
}

ExitCode check_command(const Arguments& arguments, Console& console) {
  const Scene scene = read_scene(arguments.input, arguments.read);
  console.has_read(scene.files);
  const Settings settings = effective_settings(arguments.common, arguments.solve, scene);
  warn_about_scene(scene, console);
  RunReport report = new_report(arguments.input);
  report.seconds.read = console.elapsed();

  const auto prepared = prepare(scene, settings, console.monitor(), report.seconds);
  if (!prepared) {
    console.warn("interrupted before the mesh was complete; nothing more is known.");
    return kInterrupted;
  }
  const auto& [patches, repairs, rays, lights, lit_sides] = *prepared;
  const SensorPlanes sensors = planes_of(scene.sensors);
  warn_about_places(prepared->problem(), scene, sensors, settings.solve.method, console);

  console.say(arguments.input + ": " + counted(scene.surfaces.size(), "object") + ", " +
              counted(scene.materials.size(), "material") + ", " + counted(sensors.sensor_count(), "sensor") + ", " +
              (scene.channels() == 1 ? "grey" : "in colour"));
  say_mesh(repairs, console);
  say_materials(scene, console);
  say_lights(scene, console);
  report.spaces = figures_of(scene.spaces);
  report.not_read = scene.not_read;
  say_spaces(report.spaces, console);
  say_not_read(scene, console);

  for (const std::string& hint : hints_about_panels(prepared->problem())) console.warn(scene.file + ": " + hint);

  report.settings = as_figures(settings, patches.channels, arguments.read);
  report.repairs = repairs;
  report.counts.triangles = patches.triangle_count();
  report.counts.sensors = sensors.sensor_count();
  Outputs outputs;
  finish_report(report, arguments.common, console, outputs);
  console.commit(outputs);
  return kDone;
}

}  // namespace

void add_check_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *program.add_subcommand("check", "counts, extents, materials, lights and defects of a model");
  add_input_options(command, arguments->input, arguments->read);
  add_common_options(command, arguments->common);
  command.footer("example: clerestory check data/scenes/house.json");
  command.callback([arguments, &task] {
    task = [arguments] {
      return run(arguments->common, arguments->input, {},
                 [&](Console& console) { return check_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
