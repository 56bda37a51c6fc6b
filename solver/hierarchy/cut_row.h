#pragma once
// The cut of what arrives at a receiver: few links to nodes instead of one to every leaf that was hit.

#include <span>
#include <vector>

#include "solver/hierarchy/arrivals.h"
#include "solver/hierarchy/gather_links.h"
#include "solver/hierarchy/links.h"
#include "solver/model/element_tree.h"

namespace clerestory {

/// In the order of the tree, part of the sphere after part: each part is a row for cut_row().
void sort_for_cut(std::vector<Arrival>& arrivals);

/// Hits, sorted in the order of the tree, are cut at its nodes from the root: a node takes all under it when
///   (sum of w) * (standard deviation of B over its area) <= limit
/// and |sum of w (B of the node - B of the leaf that was hit)|, added up over the nodes taken so far (what is owed),
/// stays below a tenth of that: what is hidden of a node is darker than what is seen, and without the second condition
/// a row loses 2 %. What is still owed at the end of the row moves from its darkest to its brightest link.
///
/// row    sorted, of one part of the sphere; may be empty.
/// nodes  B as known so far.
/// limit  irradiance [W/m2]; it grows up to 64 times where a row would have more than 192 links. 0: nothing is merged
///        but the hits of one leaf, and `nodes` may be empty.
/// out    the links are appended.
void cut_row(std::span<const Arrival> row, const ElementTree& tree, const NodeLight& nodes, double limit,
             std::vector<Link>& out);

}  // namespace clerestory
