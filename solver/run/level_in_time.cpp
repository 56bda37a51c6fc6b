#include "solver/run/level_in_time.h"

#include "solver/paths/find_slit_gains.h"
#include "solver/run/accuracy.h"

namespace clerestory {
namespace {

/// Times what the draft has: time to prepare and to solve elements, and points that are gathered of those on its
/// elements.
struct Growth {
  double elements, points;
};
Growth growth(Accuracy level) {
  if (level == Accuracy::draft) return {1, 1.5};
  return level == Accuracy::standard ? Growth{2.5, 3.5} : Growth{6, 9};
}

}  // namespace

LevelsInTime levels_in_time(const DraftInTime& draft) {
  const Illumination light =
      gather_illumination_by_slits(draft.elements, draft.solution.B, draft.solution.slit_light, draft.seed);
  const auto gathering = [&](Accuracy level) {
    const Effort e = effort(level);
    const VertexLightmap& at = draft.points;
    const Gathers vertices{at.sample_position.size(), sample_points(at, draft.elements.rays), e.vertices};
    const Gathers sensors{draft.sensors.count, draft.sensors.place, e.sensors};
    return growth(level).points * static_cast<double>(vertices.count) * seconds_a_gather(light, vertices, draft.seed) +
           static_cast<double>(sensors.count) * seconds_a_gather(light, sensors, draft.seed);
  };
  LevelsInTime found{Accuracy::draft, Accuracy::draft};
  for (const Accuracy level : {Accuracy::standard, Accuracy::fine}) {
    if (level > draft.at_most) break;
    const double seconds = gathering(level);
    if (growth(level).elements * draft.seconds + seconds <= draft.seconds_left) found.from_the_start = level;
    if (seconds <= draft.seconds_left) found.from_here = level;
  }
  return found;
}

}  // namespace clerestory
