#pragma once
// Elements halved where caustics vary inside of them.

#include <span>

#include "solver/hierarchy/element_mesh.h"
#include "solver/hierarchy/refine.h"
#include "solver/illumination/problem.h"

namespace clerestory {

/// Halves elements, and their halves, while two of the four parts of one differ in what caustics give them by more than
/// the tolerance of all its light, beyond three standard errors of the particles that land there. Rays do not see that.
///
/// before   with the elements that were leaves when their irradiance E was found; numbers: theirs, of the mesh.
/// returns  how many were halved for their own sake; none where the problem has no caustics.
std::size_t halve_at_caustics(ElementMesh& mesh, const Problem& before, std::span<const std::uint32_t> numbers,
                              const Field& E, const RefineOptions& options, const Monitor& monitor = {});

}  // namespace clerestory
