#pragma once
// --set LAYER=FACTOR, as often as there are layers.

#include <string>
#include <vector>

#include "pipeline/mix/mix_layers.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace clerestory {

/// What is wrong with one, or nothing.
std::string problem_with_factor(const std::string& set);

/// Of those that have no problem.
std::vector<LayerFactor> layer_factors(const std::vector<std::string>& set);

CLI::Option* add_set_option(CLI::App& command, std::vector<std::string>& set);

}  // namespace clerestory
