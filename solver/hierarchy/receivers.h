#pragma once
// Which leaves receive alone, and which together.

#include <cstdint>
#include <vector>

#include "solver/hierarchy/links.h"
#include "solver/model/element_tree.h"
#include "solver/model/patch_set.h"

namespace clerestory {

inline constexpr std::uint32_t kMostMembers = 32;  ///< leaves of a cluster that receives

/// Receivers in tree order: clusters of few patches, none of them halved, within the diameter [m], and the leaves
/// outside of them; parts of an element that was cut along the edge of a shadow receive together, as what is cut there
/// is direct light alone. The diameter grows where there would be more than `most`. 0: leaves alone.
std::vector<Receiver> choose_receivers(const ElementTree& tree, const PatchSet& patches, double diameter,
                                       std::size_t most);

}  // namespace clerestory
