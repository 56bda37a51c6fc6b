#pragma once
// A lightmap on vertices, as bake writes it.

#include <array>
#include <cstdint>
#include <vector>

#include "solver/model/channels.h"
#include "solver/model/vec.h"

namespace clerestory {

/// V vertices and N triangles of the surfaces of a result. A vertex belongs to one surface and one side.
struct BakedMesh {
  std::vector<Vec3> position, normal;  ///< V; scene's frame [m]; unit, of the lit side
  Field E;                             ///< V x channels, irradiance [W/m2]
  std::vector<float> illuminance;      ///< V [lx]
  /// V, linear light for a screen before exposure [W/m2], by which 1 / exposure is white: irradiance, and of surfaces
  /// that glow what they send.
  Field shown;
  std::vector<std::array<float, 2>> atlas_uv;           ///< V, in [0, 1], v down; empty: without an atlas
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< N, vertices, counter-clockwise from the lit side
  std::vector<std::uint32_t> surface, material;         ///< N, as in the result
};

}  // namespace clerestory
