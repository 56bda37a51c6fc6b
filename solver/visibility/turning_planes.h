#pragma once
// Mirrors and panes of a model, and the planes that they lie in.

#include <cstdint>
#include <functional>
#include <vector>

#include "solver/model/patch_set.h"
#include "solver/visibility/mirror_planes.h"

namespace clerestory {

struct TurningPlanes {
  struct Mirror {
    Vec3 normal;
    double offset;        ///< of its own plane
    std::uint32_t plane;  ///< its number in `planes`, or kNoPlane
    Spectrum reflectance;
  };
  std::vector<Mirror> mirrors;
  std::vector<std::uint32_t> mirror_of_triangle;  ///< number in `mirrors` or kNoMirror; empty without mirrors
  std::vector<std::uint32_t> glass_plane;         ///< number in `planes` or kNoPlane, by triangle; empty without glass
  std::vector<MirrorPlane> planes;                ///< of mirrors, then of glass: 64 of either at most

  static constexpr std::uint32_t kNoMirror = 0xffffffff;
  /// Null: t is none. Needs: mirrors.
  const Mirror* mirror_at(TriangleId t) const {
    return t.valid() && mirror_of_triangle[t] != kNoMirror ? &mirrors[mirror_of_triangle[t]] : nullptr;
  }
};

/// Triangles in one plane, and a rectangle around them.
struct TrianglesInPlane {
  MirrorPlane plane;
  double area = 0;
  std::vector<TriangleId> triangles;
};
/// The 64 planes of largest area of the triangles that `belongs` is true of, the largest first. Where there are more,
/// and particles follow light over those without one (illumination/caustic_legs.h), only what has a 64th of all area:
/// facets of curved surfaces have none.
std::vector<TrianglesInPlane> largest_planes(const PatchSet& patches, double diameter,
                                             const std::function<bool(TriangleId)>& belongs, bool particles_follow);

/// Planes of mirrors, as they come where they are 64 or fewer; of glass those of largest area.
/// diameter  of the model [m]: a millionth of it tells planes apart.
TurningPlanes find_turning_planes(const PatchSet& patches, double diameter);

}  // namespace clerestory
