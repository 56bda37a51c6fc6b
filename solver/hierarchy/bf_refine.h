#pragma once
// Classic refinement of links by the flux at stake, to compare with links by bundles.

#include <cstdint>
#include <vector>

#include "solver/hierarchy/links.h"
#include "solver/illumination/problem.h"
#include "solver/model/element_tree.h"
#include "solver/model/monitor.h"

namespace clerestory {

struct BfOptions {
  double flux_at_stake = 0;  ///< links above it are refined [W]
  std::uint64_t seed = 1;
};

struct BfLinks {
  Transport transport;
  std::vector<std::uint32_t> to_halve;  ///< leaves (PatchId) whose links are still above the threshold
};

/// From every patch to the root of the tree: while the flux at stake, rho_p F B_q A_p with an upper bound of F, is
/// above the threshold, the larger of both is replaced by its children. A link's F V is the mean kernel of 16 point
/// pairs, times what is visible of them; between near leaves the closed form times that. Of a cluster that sends,
/// points are chosen by what its leaves send, once that is known: what cannot be seen of it may be the brightest; else
/// by area.
///
/// B  N x channels, radiosity known so far.
/// Source: Hanrahan, Salzman & Aupperle, "A rapid hierarchical radiosity algorithm", 1991; Smits, Arvo & Greenberg, "A
/// clustering algorithm for radiosity in complex environments", 1994.
BfLinks bf_refine(const Problem& problem, const ElementTree& tree, const Field& B, const BfOptions& options,
                  const Monitor& monitor = {});

}  // namespace clerestory
