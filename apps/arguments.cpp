#include "apps/arguments.h"

#include <cmath>

#include <CLI/CLI.hpp>

namespace clerestory {
namespace {

std::string positive_number(const std::string& text) {
  double value = 0;
  if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0) return {};
  return text + " is not a number above 0";
}

}  // namespace

void add_common_options(CLI::App& command, CommonArguments& arguments) {
  command.add_option("--threads", arguments.threads, "0 = all cores; never changes the result")
      ->type_name("N")
      ->capture_default_str()
      ->check(CLI::Range(0, 4096));
  command.add_flag("--quiet", arguments.quiet, "no progress and no summary; errors and warnings only");
  command.add_flag("--verbose", arguments.verbose, "say more: a line for each round of the solver")
      ->excludes("--quiet");
  command.add_option("--log", arguments.log, "also write all messages here, with the time")->type_name("FILE");
  command.add_option("--report", arguments.report, "figures of the run as JSON")->type_name("FILE.json");
}

void add_input_options(CLI::App& command, std::string& input, ReadOptions& options) {
  command.add_option("INPUT", input, "scene (.json) or model (.obj .glb .gltf .ply .stl .off .dae .fbx .ifc)")
      ->required();
  command.add_option("--unit", options.unit, "unit of a model given directly (default: what the file says, else m)")
      ->type_name("m|cm|mm|ft|in")
      ->check(CLI::IsMember({"m", "cm", "mm", "ft", "in"}).name(""));
  command.add_option("--up", options.up, "axis that points up in a model given directly (default: as above, else z)")
      ->type_name("y|z")
      ->check(CLI::IsMember({"y", "z"}).name(""));
  command
      .add_option("--sky", options.sky, "sky for a model given directly: uniform or cie-overcast, lux on open ground")
      ->type_name("NAME[:LUX]");
}

void add_positive_option(CLI::App& command, const std::string& name, std::optional<double>& value,
                         const std::string& unit, const std::string& help) {
  command.add_option(name, value, help)->type_name(unit)->check(CLI::Validator(positive_number, ""));
}

void require_extension(CLI::App& command, const std::string& option, const std::string& extension) {
  command.get_option(option)->check(CLI::Validator(
      [extension](const std::string& file) {
        return file.ends_with(extension) ? std::string() : file + " does not end in " + extension;
      },
      ""));
}

}  // namespace clerestory
