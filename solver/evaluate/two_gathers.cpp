#include "solver/evaluate/two_gathers.h"

#include "solver/gather/gather.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/paths/find_slit_gains.h"

namespace clerestory {

std::vector<std::array<double, 2>> two_gathers(const Problem& problem, const Solution& solution, std::size_t count,
                                               const PointOf& point_of, const GatherQuality& quality, std::uint64_t key,
                                               const Monitor& monitor) {
  const Illumination light = gather_illumination_by_slits(problem, solution.B, solution.slit_light, key, monitor);
  // The points of one pattern share its strata, so what one of them makes of chance the next one does, too: several.
  constexpr std::size_t kPatterns = 8;
  std::vector<std::array<double, 2>> found(count);
  for (std::size_t p = 0; p < kPatterns; ++p) {
    const std::size_t of_pattern = (count + kPatterns - 1 - p) / kPatterns;
    for (std::size_t which = 0; which < 2; ++which) {
      const GatherPattern pattern(quality, stream_key(key, kErrorGathers, 2 * p + which));
      const PointIrradiance at = gather_at(
          light, of_pattern, [&](std::size_t k) { return point_of(p + k * kPatterns); }, pattern, "error", monitor);
      if (!at.complete()) return {};
      for (std::size_t k = 0; k < of_pattern; ++k) found[p + k * kPatterns][which] = luminous_mean(at.E[k]);
    }
  }
  return found;
}

}  // namespace clerestory
