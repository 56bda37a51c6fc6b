#pragma once
// Parts of a model that hang together and have fine facets.

#include <span>
#include <vector>

#include "meshing/surface_complex.h"
#include "solver/model/material.h"

namespace clerestory {

struct FinePart {
  std::vector<std::uint32_t> faces;  ///< in FaceComplex::faces, ascending
  std::vector<std::uint32_t>
      held_vertices;  ///< of its rims, that other parts have too, or that fine ones of theirs come near; ascending
};

/// Faces of one surface and one material that hang together over edges, where at least one is lower than `narrow`. An
/// edge that has not two faces wound the same way is a rim. The material only reflects: what emits keeps its area, and
/// what is looked through its plane.
std::vector<FinePart> fine_parts(const FaceComplex& complex, std::span<const Material> materials, double narrow);

}  // namespace clerestory
