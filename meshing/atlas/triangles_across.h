#pragma once
// Which triangles of a result hang together.

#include <array>
#include <cstdint>
#include <vector>

#include "solver/model/written_result.h"

namespace clerestory {

/// Triangles over edges, by triangle: over edge k, from corner k to the next.
using TrianglesAcross = std::vector<std::array<std::uint32_t, 3>>;
inline constexpr std::uint32_t kNoTriangle = 0xffffffff;

/// The other triangle with the same two points; kNoTriangle where there is none, or more than one.
TrianglesAcross triangles_across(const WrittenResult& result);

}  // namespace clerestory
