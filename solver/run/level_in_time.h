#pragma once
// Which level of accuracy the time that is left is enough for.

#include <cstdint>

#include "solver/gather/gather_time.h"
#include "solver/illumination/problem.h"
#include "solver/model/method.h"
#include "solver/model/solution.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {

/// What a draft by the hierarchical method has when its elements are solved, and time is short.
struct DraftInTime {
  const Problem& elements;
  const Solution& solution;      ///< of the elements
  const VertexLightmap& points;  ///< their corners
  Gathers sensors;               ///< of any quality
  double seconds;                ///< that patches and elements took
  double seconds_left;
  Accuracy at_most;  ///< no finer level is asked for
  std::uint64_t seed;
};

struct LevelsInTime {
  Accuracy from_the_start;  ///< the finest that seems to be done by then, from patches on; draft where none is
  Accuracy from_here;       ///< the same of vertices and sensors alone, on the elements that there are
};
/// What levels take was measured (solver/run/README.md), within a factor of two.
LevelsInTime levels_in_time(const DraftInTime& draft);

}  // namespace clerestory
