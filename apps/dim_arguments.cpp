#include "apps/dim_arguments.h"

#include <cmath>

#include <CLI/CLI.hpp>

#include "io/text.h"
#include "solver/dimming/dim_to_target.h"

namespace clerestory {
namespace {

/// The last '=' parts name and number: names may have one.
std::optional<GridTarget> grid_target_of(std::string_view words) {
  constexpr std::string_view kMinimum = ":min";
  GridTarget target;
  target.of_minimum = words.ends_with(kMinimum);
  if (target.of_minimum) words.remove_suffix(kMinimum.size());
  const std::size_t at = words.rfind('=');
  if (at == words.npos || at == 0) return {};
  const auto lux = to_number(words.substr(at + 1));
  if (!lux || !std::isfinite(*lux) || !(*lux >= kLeastTarget)) return {};
  target.grid = words.substr(0, at);
  target.lux = *lux;
  return target;
}

std::string problem_with_grid_target(const std::string& words) {
  return grid_target_of(words)
             ? std::string()
             : text("'", quotable(words), "' is no illuminance of ", kLeastTarget,
                    " lx or more of a set of sensors; write GRID=LUX for its mean or GRID=LUX:min for its least "
                    "sensor, as in desk=500");
}

std::string problem_with_uniformity(const std::string& words) {
  const auto u = to_number(words);
  return u && *u > 0 && *u <= 1
             ? std::string()
             : "'" + quotable(words) + "' is outside (0, 1]; it is the least over the mean, as in 0.6";
}

std::string problem_with_most(const std::string& words) {
  const auto most = to_number(words);
  return most && *most > 0 && *most <= kMostFactor ? std::string()
                                                   : text("'", quotable(words), "' is outside (0, ", kMostFactor, "]");
}

}  // namespace

void add_dim_options(CLI::App& command, DimArguments& arguments) {
  CLI::Option* target =
      command
          .add_option(
              "--target", arguments.targets,
              "dims luminaires and glowing materials, by layer, to the least flux that gives the sensors GRID a mean "
              "of LUX; LUX:min is for the least of them; may be repeated")
          ->type_name("GRID=LUX[:min]")
          ->expected(1)
          ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
          ->check(CLI::Validator(problem_with_grid_target, ""));
  command
      .add_option("--uniformity", arguments.uniformity, "least over mean that sensors of a target should have, up to 1")
      ->type_name("U")
      ->check(CLI::Validator(problem_with_uniformity, ""))
      ->needs(target);
  command.add_option("--max", arguments.most, "largest factor on a layer that --target may use (default: 1)")
      ->type_name("FACTOR")
      ->check(CLI::Validator(problem_with_most, ""))
      ->needs(target);
  command.add_flag("--commission", arguments.commission, "one factor for all layers that --target may dim")
      ->needs(target);
}

std::optional<DimRequest> dim_request(const DimArguments& arguments) {
  if (arguments.targets.empty()) return {};
  DimRequest request;
  for (const std::string& words : arguments.targets)
    if (const auto target = grid_target_of(words)) request.targets.push_back(*target);
  request.uniformity = arguments.uniformity;
  request.most = arguments.most.value_or(1);
  request.commission = arguments.commission;
  return request;
}

}  // namespace clerestory
