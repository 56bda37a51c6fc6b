#pragma once
// A problem for paths, which do not find caustics: surfaces glow with what these light up.

#include <optional>

#include "solver/illumination/problem.h"

namespace clerestory {

/// The same problem with what its caustics add to the radiosity of each patch in its exitance, and without their legs.
/// What they give to a receiver itself is for caustic_irradiance() to tell. The problem itself where it has none.
class WithoutCaustics {
 public:
  explicit WithoutCaustics(const Problem& problem);
  WithoutCaustics(const WithoutCaustics&) = delete;
  WithoutCaustics& operator=(const WithoutCaustics&) = delete;

  const Problem& problem() const { return problem_; }

 private:
  std::optional<PatchSet> patches_;
  std::optional<Lights> lights_;
  Problem problem_;
};

}  // namespace clerestory
