#include "apps/target_arguments.h"

#include <cmath>
#include <optional>

#include <CLI/CLI.hpp>

#include "io/text.h"

namespace clerestory {
namespace {

struct NamedTarget {
  std::optional<std::string> name;
  double lux = 0;
};

/// The last '=' parts them: names may have one, numbers none.
std::optional<NamedTarget> target_of(const std::string& words) {
  const std::size_t at = words.rfind('=');
  const auto lux = to_number(at == words.npos ? words : words.substr(at + 1));
  if (!lux || !std::isfinite(*lux) || !(*lux > 0) || at == 0) return {};
  NamedTarget target;
  target.lux = *lux;
  if (at != words.npos) target.name = words.substr(0, at);
  return target;
}

}  // namespace

std::string problem_with_target(const std::string& target) {
  return target_of(target)
             ? std::string()
             : "'" + quotable(target) + "' is no illuminance above 0 lx; write LUX or NAME=LUX, as in 500";
}

ReportTargets report_targets(const std::vector<std::string>& targets) {
  ReportTargets all;
  for (const std::string& words : targets) {
    const auto target = target_of(words);
    if (!target) continue;
    if (target->name)
      all.of_set[*target->name] = target->lux;
    else
      all.of_all = target->lux;
  }
  return all;
}

void add_target_option(CLI::App& command, std::vector<std::string>& targets) {
  CLI::Validator known(problem_with_target, "");
  command
      .add_option("--target", targets,
                  "illuminance that sensors should have, in lux; NAME=LUX of the sensors of that name, may be repeated "
                  "(default: the threshold that the scene gives them)")
      ->type_name("[NAME=]LUX")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->check(known);
}

}  // namespace clerestory
