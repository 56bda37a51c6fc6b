#include "solver/paths/without_caustics.h"

#include "solver/illumination/caustic_legs.h"

namespace clerestory {
namespace {

std::optional<PatchSet> glowing(const Problem& problem) {
  if (problem.lights.caustics.legs.empty()) return {};
  PatchSet patches = problem.patches;
  const Field E = caustics_on_patches(problem, problem.lights.caustics.legs);
  for (std::size_t i = 0; i < patches.patch_count(); ++i) patches.M.add(i, problem.patches.scattered(E, i));
  return patches;
}

std::optional<Lights> without_legs(const Lights& lights) {
  if (lights.caustics.legs.empty()) return {};
  Lights rest = lights;
  rest.caustics.legs = {};
  return rest;
}

}  // namespace

WithoutCaustics::WithoutCaustics(const Problem& problem)
    : patches_(glowing(problem)),
      lights_(without_legs(problem.lights)),
      problem_{patches_ ? *patches_ : problem.patches, problem.rays, lights_ ? *lights_ : problem.lights} {}

}  // namespace clerestory
