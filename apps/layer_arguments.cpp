#include "apps/layer_arguments.h"

#include <algorithm>
#include <optional>

#include <CLI/CLI.hpp>

#include "io/text.h"

namespace clerestory {
namespace {

/// Names of layers have no '='.
std::optional<LayerFactor> factor_of(const std::string& words) {
  const std::size_t at = words.find('=');
  if (at == words.npos || at == 0) return {};
  const auto factor = to_number(words.substr(at + 1));
  if (!factor || !(*factor >= 0 && *factor <= kMostFactor)) return {};
  return LayerFactor{words.substr(0, at), *factor};
}

std::string problem_with_factor(const std::string& set) {
  if (factor_of(set)) return {};
  return text("'", quotable(set), "' is no factor from 0 to ", kMostFactor,
              " on a layer; write LAYER=FACTOR, as in desk=0.4");
}

}  // namespace

std::vector<LayerFactor> layer_factors(const std::vector<std::string>& set) {
  std::vector<LayerFactor> factors;
  for (const std::string& words : set) {
    const auto factor = factor_of(words);
    if (!factor) continue;
    if (std::ranges::find(factors, factor->layer, &LayerFactor::layer) != factors.end())
      throw CLI::ValidationError("--set", text("layer '", quotable(factor->layer), "' is set twice; keep one"));
    factors.push_back(*factor);
  }
  return factors;
}

void add_set_option(CLI::App& command, std::vector<std::string>& set) {
  command
      .add_option("--set", set, "a factor on a layer, 0 is off and 1 as it is; may be repeated (default: 1 for all)")
      ->type_name("LAYER=FACTOR")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->check(CLI::Validator(problem_with_factor, ""));
}

}  // namespace clerestory
