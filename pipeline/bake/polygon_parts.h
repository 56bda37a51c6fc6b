#pragma once
// Polygons of a scene -> triangles to put light on.

#include <vector>

#include "solver/model/model_part.h"
#include "solver/model/scene.h"

namespace clerestory {

struct PolygonParts {
  std::vector<ModelPart> parts;
  std::vector<SurfaceId> surface;    ///< of each
  std::vector<MaterialId> material;  ///< of each
};

/// A part for each wanted surface and material of it, in their order. Vertices stay as they are; where a polygon
/// crosses itself some are added.
///
/// wanted  by SurfaceId
PolygonParts polygon_parts(const Scene& scene, const std::vector<bool>& wanted);

}  // namespace clerestory
