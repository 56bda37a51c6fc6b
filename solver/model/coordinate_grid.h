#pragma once
// How exact places of a meshed model are.

namespace clerestory {

/// Meshing rounds vertices to a grid of this share of the model's diagonal: far below every tolerance, far above
/// rounding, so that the same model in another unit or place gives the same coordinates, and with them the same mesh.
/// What lies nearer to a surface's plane than that lies in it.
inline constexpr double kCoordinateGrid = 0x1p-32;

}  // namespace clerestory
