#pragma once
// Which sides light can reach at all.

#include <cstdint>

#include "solver/problem.h"

namespace clerestory {

struct LitSides {
  std::vector<bool> wanted;       ///< 2T, for make_patches()
  std::size_t dark_sides = 0;     ///< sides no light reaches: inside solids, outside of sealed rooms
  std::size_t lamp_interiors = 0; ///< emitting sides that only see the inside of their own lamp
};

/// Follows light over rays from the luminaires, sky, sun and emitting sides to every side they can reach in any number
/// of bounces. An emitting side is dropped too when its light can meet no other surface (outside of a glowing room), or
/// only the inside of the same lamp body.
LitSides find_lit_sides(const Problem& problem, std::uint64_t seed = 0);

}  // namespace clerestory
