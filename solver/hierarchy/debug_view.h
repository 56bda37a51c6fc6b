#pragma once
// A look at one round of the hierarchy.

#include "solver/hierarchy/links.h"
#include "solver/hierarchy/trace_links.h"
#include "solver/illumination/illumination.h"
#include "solver/model/element_tree.h"
#include "solver/model/hierarchy_debug.h"
#include "solver/model/solution.h"

namespace clerestory {

/// Fills all of `view` but its error. light, options: as the links were traced; solution: what they balanced.
void view_round(const Illumination& light, const ElementTree& tree, const Transport& transport,
                const LinkOptions& options, const Solution& solution, HierarchyDebug& view);

}  // namespace clerestory
