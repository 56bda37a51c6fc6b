#pragma once
// --target GRID=LUX[:min], --uniformity, --max, --commission: lamps dimmed to what sensors should have.

#include <optional>
#include <string>
#include <vector>

#include "pipeline/mix/find_factors.h"

namespace CLI {
class App;
}

namespace clerestory {

struct DimArguments {
  std::vector<std::string> targets;
  std::optional<double> uniformity, most;
  bool commission = false;
};

void add_dim_options(CLI::App& command, DimArguments& arguments);

/// Nothing without a target. Needs: words that the command line took.
std::optional<DimRequest> dim_request(const DimArguments& arguments);

}  // namespace clerestory
