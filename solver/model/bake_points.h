#pragma once
// A result as a lightmap on vertices, on the mesh that the light needs.

#include <vector>

#include "solver/model/baked_mesh.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// One vertex for each point of the result, in its order. Normals are the means by area of the facets around.
BakedMesh baked_points(const WrittenResult& result);

/// By material: its surfaces send more than they reflect, for they glow or pass light on, so that what they send is
/// shown of them, and white is their colour.
std::vector<bool> glowing_materials(const WrittenResult& result);

/// BakedMesh::shown at the points of the result [W/m2]. Black sides, as one-sided materials have them, show no light.
Field shown_at_points(const WrittenResult& result, const std::vector<bool>& glows);

/// A place near `positions` for files whose positions are float: the origin where float is exact enough there, else
/// the middle of them in whole metres [m].
Vec3 near_origin(const std::vector<Vec3>& positions);
inline constexpr double kFarFromOrigin = 4096;  ///< float is good for a quarter of a millimetre up to here [m]

}  // namespace clerestory
