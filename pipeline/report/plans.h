#pragma once
// Plans of what was measured: sensor grids; and of floors where there are none.

#include <optional>
#include <string>
#include <vector>

#include "io/page/plan.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// Seen along its normal where that is not vertical, else from above, y up. Its lattice as cells with isolux lines,
/// other points as dots; where its plane cuts the model, panes and luminaires around it.
Plan plan_of(const WrittenResult& result, const MeasuredSensors& sensors, std::optional<double> target);

struct FloorPlan {
  double height = 0;  ///< [m]
  double area = 0;    ///< [m2]
  Plan plan;
};

/// Upward surfaces at the heights where most of them lie, lowest first; the outdoors only when there is nothing else.
std::vector<FloorPlan> floor_plans(const WrittenResult& result, std::size_t most);

}  // namespace clerestory
