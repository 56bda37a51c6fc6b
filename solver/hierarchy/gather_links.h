#pragma once
// Flat passes over tree and links: pull, gather, push.

#include "solver/hierarchy/links.h"
#include "solver/model/channels.h"
#include "solver/model/element_tree.h"

namespace clerestory {

// A field's channels are lanes here: colour channels of one distribution of light after another, any number of them.

/// V x lanes values of all nodes from N x lanes of the leaves (by PatchId), averaged by area.
void pull(const ElementTree& tree, const Field& leaves, Field& nodes);

/// E_p = sum over links of weight * B, and down to the leaves. nodes: V x lanes, from pull(); E: N x lanes, by PatchId.
/// Eight lanes of a link in one go, or all of fewer; blocks in parallel. A lane's bits do not depend on the others.
void gather_and_push(const Transport& transport, const ElementTree& tree, const Field& nodes, Field& E);

/// Radiosity of the nodes, as far as links need it.
struct NodeLight {
  std::vector<float> mean;       ///< V, luminous [W/m2]
  std::vector<float> deviation;  ///< V, standard deviation over the area, of the channel that varies most [W/m2]
};
NodeLight node_light(const ElementTree& tree, const Field& B);

}  // namespace clerestory
