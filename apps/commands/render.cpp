// clerestory render: a picture of a result, without a display.

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/finish_report.h"
#include "apps/run.h"
#include "apps/solution_warnings.h"
#include "apps/view_words.h"
#include "io/annual/year_part_tables.h"
#include "io/atomic_file.h"
#include "io/picture/encode.h"
#include "io/read_result.h"
#include "pipeline/scene_of_result.h"
#include "pipeline/view/render_view.h"
#include "pipeline/wording.h"

namespace clerestory {
namespace {

struct Arguments {
  CommonArguments common;
  std::string input, output;
  ViewRequest view;
  bool fits = false;

  bool as_exr() const { return output.ends_with(".exr"); }
};

ExitCode render_command(const Arguments& arguments, Console& console) {
  if (const Problem problem = problem_with_view(arguments.view, arguments.as_exr()); !problem.empty()) {
    console.fail(problem + ".");
    return kWrongUsage;
  }
  check_writable(arguments.output);
  require_picture_files();
  const WrittenResult result = read_result(arguments.input);
  require_whole_year(result);
  console.has_read(files_of_scene(result, arguments.input));
  const RenderedView view =
      render_view(result, arguments.input, arguments.view, arguments.as_exr(), console, console.monitor());
  repeat_warnings(result, console);
  RunReport report = new_report(arguments.input);
  report.counts.triangles = result.triangles.size();
  report.settings = {{"show", arguments.view.show},
                     {"width", static_cast<long long>(view.width)},
                     {"height", static_cast<long long>(view.height)},
                     {"samples", static_cast<long long>(arguments.view.samples)}};
  if (arguments.view.wants_lights()) report.settings.push_back({"raytrace", true});
  if (arguments.view.final_gather > 0)
    report.settings.push_back({"final_gather", static_cast<long long>(arguments.view.final_gather)});
  report.log = view.notes;
  Outputs outputs;
  outputs.open(arguments.output).write(view.bytes);
  finish_report(report, arguments.common, console, outputs);
  console.say(arguments.input + ": " + std::to_string(view.width) + " x " + std::to_string(view.height) + " pixels, " +
              counted(static_cast<unsigned long long>(arguments.view.samples), "ray") + " each");
  for (const std::string& note : view.notes) console.say("  " + note);
  console.commit(outputs);
  console.say("  picture " + arguments.output);
  return kDone;
}

/// An option of words that `read` makes a value of, or says why not.
template <class Read>
CLI::Option* add_words(CLI::App& command, const std::string& name, const std::string& unit, const std::string& help,
                       const Read& read) {
  return command
      .add_option_function<std::string>(
          name,
          [name, read](const std::string& words) {
            if (const Problem problem = read(words); !problem.empty()) throw CLI::ValidationError(name, problem);
          },
          help)
      ->type_name(unit);
}

/// fits: what --fit says, which is the default anyway.
void add_camera_options(CLI::App& command, ViewRequest& view, bool& fits) {
  add_words(command, "--eye", "X,Y,Z", "where one looks from, in metres",
            [&view](const std::string& words) { return read_place(words, view.eye); });
  add_words(command, "--target", "X,Y,Z", "what one looks at, in metres",
            [&view](const std::string& words) { return read_place(words, view.target); });
  add_words(command, "--up", "X,Y,Z", "what is above in the picture (default: 0,0,1)",
            [&view](const std::string& words) { return read_place(words, view.up); });
  command
      .add_option(
          "--fov", view.fov,
          "angle across the longer side of the picture in degrees, as in Blender (default: the camera's, or 60)")
      ->type_name("DEGREES")
      ->check(CLI::Validator(
          [](std::string& words) {
            double value = 0;
            const bool is_angle = CLI::detail::lexical_cast(words, value) && value > 0 && value < 180;
            return is_angle ? std::string() : words + " is not an angle above 0 and below 180 degrees";
          },
          ""));
  CLI::Option* camera =
      command.add_option("--camera", view.camera, "a camera of the glTF model that was solved, by its name")
          ->type_name("NAME");
  command
      .add_option(
          "--scene", view.scene,
          "the scene or model that was solved, for --camera, --raytrace and --final-gather (default: where it was)")
      ->type_name("FILE");
  CLI::Option* fit = command.add_flag("--fit", fits, "from outside above a corner into the rooms; the default");
  CLI::Option* plan =
      add_words(command, "--plan", "Z", "a plan of what is below this height in metres, to scale, +y up",
                [&view](const std::string& words) { return read_plan(words, view.cut); });
  CLI::Option* section =
      add_words(command, "--section", "x=X|y=Y", "a section seen along +x or +y from that place in metres, to scale",
                [&view](const std::string& words) { return read_section(words, view.cut); });
  command.add_flag("--outdoors", view.outdoors,
                   "of --fit, --plan and --section: show what is outdoors, too, where there are rooms");
  CLI::Option* fisheye = command.add_flag("--fisheye", view.fisheye,
                                          "half a sphere by --eye and --target, or --camera: equidistant, 180 degrees");
  CLI::Option* eye = command.get_option("--eye");
  fit->excludes(plan)->excludes(section)->excludes(camera)->excludes(eye)->excludes(fisheye);
  plan->excludes(section)->excludes(camera)->excludes(eye)->excludes(fisheye);
  section->excludes(camera)->excludes(eye)->excludes(fisheye);
  camera->excludes(eye)->excludes(command.get_option("--target"));
}

}  // namespace

void add_render_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *program.add_subcommand("render", "a picture of a result, in true or false colours");
  ViewRequest& view = arguments->view;
  add_solution_input(command, arguments->input);
  command
      .add_option("-o,--output", arguments->output,
                  "the picture; an .exr holds the values themselves: lux, cd/m2, %, of colours W/(m2 sr)")
      ->type_name("VIEW.png|.exr")
      ->required();
  require_extension(command, "--output", {".png", ".exr"});
  add_camera_options(command, view, arguments->fits);
  add_words(command, "--size", "WIDTHxHEIGHT", "of the view in pixels; a legend comes beside it (default: 1920x1080)",
            [&view](const std::string& words) { return read_size(words, view.width, view.height); });
  command.add_option("--samples", view.samples, "rays a pixel (default: 16)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command.add_flag("--raytrace", view.raytrace,
                   "read the scene again and find the light of lamps and sun by rays at each place that is seen: "
                   "sharp shadows, and highlights on gloss");
  command
      .add_option("--final-gather", view.final_gather,
                  "with that, N rays from each place look for all other light, too: no trace of the mesh, and slow "
                  "(default: it is the result's)")
      ->type_name("N")
      ->check(CLI::Range(16, 4096));
  command
      .add_option("--show", view.show,
                  "colour, luminance, illuminance, daylight_factor or another array on the points of the result "
                  "(default: colour)")
      ->type_name("NAME");
  add_exposure_option(command, view.ev);
  add_words(command, "--range", "LOW:HIGH", "of false colours, in the unit shown (default: around what is seen)",
            [&view](const std::string& words) { return read_range(words, view.range); });
  command.add_flag("--log-scale", view.log_scale, "false colours by logarithm");
  add_words(command, "--isolux", "A,B,...",
            "lines of equal value, with their numbers: of what is shown, with true colours of illuminance in lux",
            [&view](const std::string& words) { return read_levels(words, view.isolux); });
  add_common_options(command, arguments->common);
  command.footer(
      "example: clerestory render office.vtp -o plan.png --plan 1.2 --show illuminance --isolux 300,500,750");
  command.callback([arguments, &task] {
    task = [arguments] {
      return run(arguments->common, arguments->input,
                 {{"--scene", arguments->view.scene, false}, {"-o", arguments->output}},
                 [&](Console& console) { return render_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
