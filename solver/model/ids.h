#pragma once
// Typed indices, so that a patch number cannot index materials.

#include <cstdint>
#include <limits>

namespace clerestory {

template <class Tag>
struct Id {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t value = kNone;

  constexpr Id() = default;
  constexpr explicit Id(std::size_t v) : value(static_cast<std::uint32_t>(v)) {}
  constexpr bool valid() const { return value != kNone; }
  constexpr operator std::size_t() const { return value; }  // indexes arrays; no way back without naming the type
};

using VertexId = Id<struct VertexTag>;
using TriangleId = Id<struct TriangleTag>;  ///< a triangle of PatchSet, with two sides
using PatchId = Id<struct PatchTag>;        ///< one side of a triangle that takes part in transport
using MaterialId = Id<struct MaterialTag>;
using SurfaceId = Id<struct SurfaceTag>;  ///< a named object of the model

}  // namespace clerestory
