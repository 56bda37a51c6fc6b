#pragma once
// --set LAYER=FACTOR, as often as there are layers.

#include <string>
#include <vector>

#include "pipeline/mix/mix_layers.h"

namespace CLI {
class App;
}

namespace clerestory {

void add_set_option(CLI::App& command, std::vector<std::string>& set);

/// Needs: words that the command line took.
/// throws  CLI::ValidationError when a layer is set twice.
std::vector<LayerFactor> layer_factors(const std::vector<std::string>& set);

}  // namespace clerestory
