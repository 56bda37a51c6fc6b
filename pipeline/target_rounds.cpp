#include "pipeline/target_rounds.h"

namespace clerestory {

std::size_t round_for(double target, std::size_t now, double error) {
  const double of_draft = error / kTargetRounds[now].error;
  for (std::size_t next = now + 1; next < kTargetRounds.size(); ++next)
    if (of_draft * kTargetRounds[next].error <= target) return next;
  return now + 1;
}

}  // namespace clerestory
