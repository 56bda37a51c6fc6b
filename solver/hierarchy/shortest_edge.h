#pragma once
// How small elements may become.

#include <algorithm>
#include <vector>

#include "solver/model/patch_set.h"

namespace clerestory {

/// No edge is halved below this [m]. A room inside a large building is resolved as it would be alone, so it may have a
/// limit of its own.
struct ShortestEdge {
  double anywhere = 0;
  std::vector<double> in_room;  ///< by PatchSet::room; empty: the same in all

  ShortestEdge() = default;
  ShortestEdge(double edge) : anywhere(edge) {}  // NOLINT: a length is one

  /// patches  those that were not halved.
  double of(const PatchSet& patches, std::size_t p) const {
    return in_room.empty() || patches.room.empty() ? anywhere : in_room[patches.room[p]];
  }
  double least() const { return in_room.empty() ? anywhere : std::ranges::min(in_room); }
};

}  // namespace clerestory
