#include "apps/arguments.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include <CLI/CLI.hpp>

namespace clerestory {
namespace {

/// A check without CLI11's own words in the help.
template <class Problem>
CLI::Validator silent(const Problem& problem) {
  return CLI::Validator([problem](std::string& text) { return std::string(problem(text)); }, "");
}

std::string positive_number(const std::string& text) {
  double value = 0;
  if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0) return {};
  return text + " is not a number above 0";
}

std::string length_or_none(const std::string& text) {
  double value = 0;
  if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value >= 0) return {};
  return text + " is not a length of 0 or more";
}

std::string thread_number(const std::string& text) {
  int n = 0;
  if (CLI::detail::lexical_cast(text, n) && n >= 0 && n <= 4096) return {};
  return text + " is not a whole number from 0 to 4096";
}

std::string seed_number(const std::string& text) {
  const bool digits = !text.empty() && text.find_first_not_of("0123456789") == text.npos;  // "-1" would wrap around
  long long value = 0;
  if (digits && std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc{}) return {};
  return text + " is not a whole number from 0 to 9223372036854775807";
}

}  // namespace

void add_common_options(CLI::App& command, CommonArguments& arguments) {
  command.add_option("--threads", arguments.threads, "0 = all cores; never changes the result (default: 0)")
      ->type_name("N")
      ->check(silent(thread_number));
  command.add_option("--seed", arguments.seed, "of all random numbers (default: 1)")
      ->type_name("N")
      ->check(silent(seed_number));
  command.add_flag("--quiet", arguments.quiet, "no progress and no summary; errors and warnings only");
  command.add_flag("--verbose", arguments.verbose, "say more: a line for each round of the solver");
  command.add_option("--log", arguments.log, "also write all messages here, with the time")->type_name("FILE");
  command.add_option("--report", arguments.report, "figures of the run as JSON")->type_name("FILE.json");
}

void add_solution_input(CLI::App& command, std::string& input, const std::string& help) {
  command.add_option("SOLUTION", input, help)->type_name("FILE.vtp")->required();
}

void add_input_options(CLI::App& command, std::string& input, ReadOptions& options) {
  command.add_option("INPUT", input, "scene (.json) or model (.obj .glb .gltf .ply .stl .off .dae .fbx .ifc)")
      ->type_name("FILE")
      ->required();
  add_choice(command, "--unit", options.unit, {"m", "cm", "mm", "ft", "in"},
             "unit of a model given directly (default: what the file says, else m)");
  add_choice(command, "--up", options.up, {"y", "z"},
             "axis that points up in a model given directly (default: what the file says, else z)");
  command
      .add_option("--sky", options.sky,
                  "sky for a model given directly: uniform, cie-overcast, cie-general-1, -3, -5 or -16; lux on open "
                  "ground (default: 10000)")
      ->type_name("NAME[:LUX]");
  add_choice(command, "--gloss", options.gloss, {"model"},
             "take the gloss of the model's own materials (default: they are diffuse)");
}

void add_choice(CLI::App& command, const std::string& name, std::optional<std::string>& value,
                const std::vector<std::string>& choices, const std::string& help) {
  std::string all;
  for (const std::string& choice : choices) all += (all.empty() ? "" : "|") + choice;
  command.add_option(name, value, help)->type_name(all)->check(silent([=](const std::string& text) {
    return std::find(choices.begin(), choices.end(), text) != choices.end() ? "" : text + " is not one of " + all;
  }));
}

CLI::Option* add_checked_word(CLI::App& command, const std::string& name, std::optional<std::string>& value,
                              const std::function<std::string(const std::string&)>& problem, const std::string& help) {
  return command.add_option(name, value, help)->type_name("NAME")->check(silent(problem));
}

void add_detail_option(CLI::App& command, std::optional<double>& detail) {
  command
      .add_option("--detail", detail,
                  "merge finer facets of curved parts, by at most so many metres; 0 for none (default: 1/512 of the "
                  "longest element edge)")
      ->type_name("M")
      ->check(silent(length_or_none));
}

void add_positive_option(CLI::App& command, const std::string& name, std::optional<double>& value,
                         const std::string& unit, const std::string& help) {
  command.add_option(name, value, help)->type_name(unit)->check(silent(positive_number));
}

void add_exposure_option(CLI::App& command, double& exposure) {
  command
      .add_option("--exposure", exposure,
                  "so many stops brighter than what shows the middle of the rooms well; 1 is twice as bright "
                  "(default: 0)")
      ->type_name("EV")
      ->check(silent([](const std::string& text) {
        double value = 0;
        const bool is_number = CLI::detail::lexical_cast(text, value) && value >= -100 && value <= 100;
        return is_number ? std::string() : text + " is not a number from -100 to 100";
      }));
}

void require_extension(CLI::App& command, const std::string& option, const std::vector<std::string>& extensions) {
  command.get_option(option)->check(silent([extensions](const std::string& file) {
    std::string known;
    for (const std::string& extension : extensions) {
      if (file.ends_with(extension)) return std::string();
      known += (known.empty() ? "" : extension == extensions.back() ? " or " : ", ") + extension;
    }
    return file + " does not end in " + known;
  }));
}

}  // namespace clerestory
