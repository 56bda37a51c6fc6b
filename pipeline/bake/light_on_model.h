#pragma once
// The light of a result on a model's own vertices.

#include <span>
#include <vector>

#include "solver/model/model_part.h"
#include "solver/model/written_result.h"

namespace clerestory {

struct LitModel {
  std::vector<LitPart> parts;  ///< one each
  double missing_share = 0;    ///< of the result's area, where the model has no face: it was changed since [1]
};

/// At each corner of a triangle the result's triangles that cover it there, a little inside, are interpolated at the
/// corner, so that no light of beyond a partition leaks in. Vertices of several triangles take the mean where the
/// surface goes on smoothly. Faces of glass and of mirrors are left out, as in the result.
///
/// Threads: same bits for any thread count. Cost: O(n log n).
LitModel light_on_model(const WrittenResult& result, std::span<const ModelPart> parts);

}  // namespace clerestory
