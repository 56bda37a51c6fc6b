#pragma once
// Factors on the layers of a result that light its sensors as asked for.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/mix/mix_layers.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// What a set of sensors should have.
struct GridTarget {
  std::string grid;         ///< name of the set
  double lux = 0;           ///< kLeastTarget or more
  bool of_minimum = false;  ///< the least of its sensors, instead of their mean
};

struct DimRequest {
  std::vector<GridTarget> targets;     ///< one or more
  std::optional<double> uniformity{};  ///< least over mean that each set of a target should have, (0, 1]
  double most = 1;                     ///< largest factor, (0, kMostFactor]
  bool commission = false;             ///< one factor for all layers that may be dimmed
};

struct FoundFactors {
  std::vector<LayerFactor> factors;  ///< of each layer that was dimmed
  double luminous_flux = 0;          ///< of these at their factors [lm]
  double full_flux = 0;              ///< of these at factor 1 [lm]
};

/// The least flux of luminaires and glowing surfaces that gives each target at least its light. Sky and sun cannot be
/// dimmed; they count as they are, and layers of `given` with the factor that they have there.
///
/// throws  InputError when there are no sensors of that name or layers that may be dimmed; when no factors reach the
///         targets, with the best that can be had; and as factors_of() does.
FoundFactors find_factors(const WrittenResult& result, std::span<const LayerFactor> given, const DimRequest& request);

}  // namespace clerestory
