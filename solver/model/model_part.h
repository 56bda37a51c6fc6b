#pragma once
// Triangles of a model as its file shows them, before and after light is put on them.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "solver/model/channels.h"
#include "solver/model/vec.h"

namespace clerestory {

/// Triangles of one surface and one material.
struct ModelPart {
  std::string name;                                     ///< of the surface
  std::vector<Vec3> position;                           ///< P, scene's frame [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< positions, counter-clockwise around the front
  double sharp_cosine = 0.866;  ///< between facets that turn more than this (30 degrees) there is an edge
};

/// The sides of a part that light reaches, and of faces that it does not reach the front. V vertices: those of the part
/// in its order, then those that were split off, at sharp edges, at rims of light and where both sides are lit.
struct LitPart {
  std::vector<std::uint32_t> vertex;                    ///< V, of ModelPart::position
  std::vector<bool> is_back;                            ///< V, of the back of its faces
  std::vector<Vec3> normal;                             ///< V, unit, of the lit side
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertices here, counter-clockwise from the lit side
  Field E;                                              ///< V, irradiance [W/m2]
  std::vector<float> illuminance;                       ///< V [lx]
  Field shown;                                          ///< V, as BakedMesh::shown
  std::optional<std::uint32_t> material;                ///< of the result; empty where no light reaches any of it
};

}  // namespace clerestory
