#pragma once
// The transport of a scene as a value that outlives its solve: balanced for any light, without a ray.

#include <span>

#include "solver/hierarchy/balance.h"
#include "solver/hierarchy/links.h"
#include "solver/illumination/direct.h"
#include "solver/lights/layers.h"
#include "solver/model/element_tree.h"

namespace clerestory {

/// What hierarchical() knows of a scene's elements when it is done. Elements were halved, and bright sources looked at
/// by rays of their own, for the light that it was solved with; other light is balanced on the same, without bias, but
/// with more noise where what was dark is bright now.
struct KeptTransport {
  PatchSet elements;    ///< N leaves
  ElementTree tree;     ///< over them
  Transport transport;  ///< links and views of the sky
  DirectRows direct;    ///< by luminaire and sun, and the sky straight through openings
  bool complete = false;
};

/// Balances any number of layers at once.
///
/// kept    complete.
/// layers  at least one, each of any luminaires and suns that kept.direct knows, under any sky. Lamps that stand
///         elsewhere want their own rows first: kept.direct.append() those of direct_light() with a problem of these
///         lamps alone.
/// returns E, B, energy of each layer [W/m2, W].
/// Cost    no rays; eight layers of one channel balance in 1.4 times the time of one.
Balanced solve_for(const KeptTransport& kept, std::span<const Layer> layers, double residual = 1e-6,
                   const Monitor& monitor = {});

}  // namespace clerestory
