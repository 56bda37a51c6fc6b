#pragma once
// Which sides light can reach at all.

#include <cstdint>
#include <vector>

#include "solver/illumination/problem.h"
#include "solver/model/monitor.h"

namespace clerestory {

struct LitSides {
  std::vector<bool> wanted;             ///< 2T, for make_patches()
  std::vector<std::uint32_t> space;     ///< 2T, the space that a side sees, for PatchSet::space; empty: not known
  std::size_t dark_sides = 0;           ///< sides no light reaches: inside solids, outside of sealed rooms
  std::size_t luminaire_interiors = 0;  ///< emitting sides that only see the inside of their own luminaire body
};

/// Follows light over rays from luminaires, sky, sun and emitting sides to every side it can reach in any number of
/// bounces. Sides that see each other form a space; a space is dropped when no light gets in. An emitting side is
/// dropped too when its light meets no other surface (the outside of a glowing room), or only the inside of the same
/// luminaire body while the body's outside lights a space with other surfaces.
///
/// Where luminaires are the only light of an open scene, each side looks for them by shadow rays of its own. When the
/// monitor stops the search, all sides not looked at take part.
///
/// problem  with all sides as patches, as build_patches() leaves them.
LitSides find_lit_sides(const Problem& problem, std::uint64_t seed = 0, const Monitor& monitor = {});

}  // namespace clerestory
